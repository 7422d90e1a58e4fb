#include "leeway/filters/vehicle_aiding.hpp"

#include <cmath>
#include <cstdlib>
#include <cstdio>
#include "leeway/filters/vehicle_measurements.hpp"

namespace leeway {

static double env(const char* n, double d) { const char* v = std::getenv(n); return v ? std::atof(v) : d; }

VehicleConfig VehicleConfig::car() {
  VehicleConfig config;
  config.zero_velocity = config.zero_angular_rate = config.non_holonomic = config.odometer =
      config.barometer = true;
  config.zero_velocity = env("ZV", 1);
  config.zero_angular_rate = env("ZR", 1);
  config.non_holonomic = env("NH", 1);
  config.right_sigma_mps = env("RS", config.right_sigma_mps);
  config.right_sigma_s = env("RA", config.right_sigma_s);
  config.down_sigma_mps = env("DS", config.down_sigma_mps);
  config.rear_axle_x_m = env("AX", config.rear_axle_x_m);
  config.rear_axle_sigma_m = env("AXS", config.rear_axle_sigma_m);
  config.mount_sigma_rad = env("MS", config.mount_sigma_rad);
  config.mount_walk_rad_per_sqrt_s = env("MW", config.mount_walk_rad_per_sqrt_s);
  config.rest_sigma_mps = env("RV", config.rest_sigma_mps);
  config.rest_turn_sigma_radps = env("RT", config.rest_turn_sigma_radps);
  return config;
}

VehicleState vehicle_state(const VehicleConfig& config) {
  VehicleState state;
  state.value(kRearAxleX) = config.rear_axle_x_m;
  VehicleVector sigma;
  sigma << config.mount_sigma_rad, config.mount_sigma_rad, config.rear_axle_sigma_m,
      config.odometer_scale_sigma, config.height_offset_sigma_m;
  state.P = sigma.cwiseAbs2().asDiagonal();
  VehicleVector walk;
  walk << config.mount_walk_rad_per_sqrt_s, config.mount_walk_rad_per_sqrt_s, 0.0,
      config.odometer_walk_per_sqrt_s, config.height_walk_m_per_sqrt_s;
  state.random_walk_per_s = walk.cwiseAbs2();
  return state;
}

VehicleAiding::VehicleAiding(const VehicleConfig& config, const ImuErrorModel& imu)
    : config_(config),
      gyro_noise_rad_per_sqrt_s_(imu.gyro.noise_density),
      standstill_(config.standstill, imu) {}

void VehicleAiding::push(const ImuIncrement& inc, HeadingBank& bank) {
  const auto block = blocks_.push(inc);
  if (!block) return;
  at_rest_ = standstill_.push(*block, bank.best());
  a_e_ = (bank.best().estimate().nav.v_e_mps - v_e_) / block->dt_s;
  v_e_ = bank.best().estimate().nav.v_e_mps;
  at_rest_ ? rest(*block, bank) : roll(*block, bank);
}

void VehicleAiding::rest(const ImuBlock& block, HeadingBank& bank) const {
  if (config_.zero_velocity) {
    bank.update([this](Ekf& filter) {
      return filter.update(zero_velocity(filter.estimate(), config_.rest_sigma_mps));
    });
  }
  if (config_.zero_angular_rate) {
    const double noise = gyro_noise_rad_per_sqrt_s_ / std::sqrt(block.dt_s);
    const double sigma = std::hypot(noise, config_.rest_turn_sigma_radps);
    bank.update([&](Ekf& filter) {
      return filter.update(
          zero_angular_rate(filter.estimate(), block.mean_omega_ib_b_radps, sigma));
    });
  }
}

void VehicleAiding::roll(const ImuBlock& block, HeadingBank& bank) const {
  if (!config_.non_holonomic || !bank.best().estimates_vehicle()) return;
  const double speed_mps = bank.best().estimate().nav.v_e_mps.norm();
  if (speed_mps < config_.min_speed_mps) return;
  const double turn_radps =
      (block.mean_omega_ib_b_radps - bank.best().estimate().bias.b_g_radps).norm();
  const double right_mps =
      std::hypot(std::hypot(config_.right_sigma_mps, env("RW", 0.0) * turn_radps), config_.right_sigma_s * speed_mps * turn_radps, bank.collapsed() ? 0.0 : env("BO", 0.5) + env("BT", 1.0) * turn_radps);
  const double down_mps = config_.down_sigma_mps * std::pow(10.0 / speed_mps, env("DP", 0.0));
  if (std::getenv("DUMP") && bank.collapsed()) { const auto m = non_holonomic(bank.best().estimate(), bank.best().vehicle().value, bank.best().omega_ib_b_radps(), right_mps, down_mps); std::fprintf(stderr, "NHC %.3f %.3f %.4f %.4f %.4f %.5f %.5f %.3f\n", to_seconds(block.time), speed_mps, turn_radps, m.innovation(0), m.innovation(1), bank.best().vehicle().value(0), bank.best().vehicle().value(1), bank.best().vehicle().value(2)); }
  bank.update([&](Ekf& filter) {
    VehicleVector vv = filter.vehicle().value;
    static const double sq = env("SQ", 0.0);
    vv(kMountPitch) -= sq * (filter.estimate().nav.q_eb.conjugate() * a_e_).x();
    return filter.update(non_holonomic(filter.estimate(), vv,
                                       filter.omega_ib_b_radps(), right_mps, down_mps));
  });
}

}  // namespace leeway
