#include "leeway/filters/vehicle_aiding.hpp"

#include <cmath>
#include <cstdlib>
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
      std::hypot(config_.right_sigma_mps, config_.right_sigma_s * speed_mps * turn_radps);
  const double down_mps = config_.down_sigma_mps * std::pow(10.0 / speed_mps, env("DP", 0.0));
  bank.update([&](Ekf& filter) {
    return filter.update(non_holonomic(filter.estimate(), filter.vehicle().value,
                                       filter.omega_ib_b_radps(), right_mps, down_mps));
  });
}

}  // namespace leeway
