#include "leeway/navigator/vehicle_aiding.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/model/heading.hpp"
#include "leeway/model/vehicle_measurements.hpp"
#include "leeway/navigator/aidings.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway {
namespace {

// While several headings are possible the constraint only has to tell them apart.
constexpr double kOpenHeadingRightMps = 0.5;
constexpr double kOpenHeadingRightM = 1.0;

}  // namespace

VehicleConfig VehicleConfig::car() { return of(VehicleKind::kCar); }

VehicleConfig VehicleConfig::of(VehicleKind kind) {
  VehicleConfig config;
  config.kind = kind;
  if (kind != VehicleKind::kCar) return config;
  for (const VehiclePart& part : kVehicleParts) config.*part.is_on = true;
  return config;
}

void validate(const VehicleConfig& config) { validate_fields("vehicle", config); }

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
      standstill_(config.standstill, imu) {
  validate(config);
}

bool VehicleAiding::push(const ImuIncrement& inc, HeadingBank& bank) {
  const auto block = blocks_.push(inc);
  if (!block) return false;
  at_rest_ = standstill_.push(*block, bank.best());
  even_motion_s_ = standstill_.is_even(*block, bank.best()) ? even_motion_s_ + block->dt_s : 0.0;
  if (at_rest_) {
    rest(*block, bank);
    return false;
  }
  const double nis = roll(*block, bank);
  return bank.collapsed() && cusum_.push(nis, 1);
}

void VehicleAiding::rest(const ImuBlock& block, HeadingBank& bank) const {
  if (config_.zero_velocity) {
    bank.update([this](Ekf& filter) {
      return filter.update(zero_velocity(filter.estimate(), config_.rest_sigma_mps),
                           rest_hides_heading(filter) ? Held::kHeadingAndTurn : Held::kNothing);
    });
  }
  if (config_.zero_angular_rate) {
    const double sigma = rest_turn_sigma_radps(config_, gyro_noise_rad_per_sqrt_s_, block.dt_s);
    bank.update([&](Ekf& filter) {
      return filter.update(zero_angular_rate(filter.estimate(), block.mean_omega_ib_b_radps, sigma),
                           rest_hides_heading(filter) ? Held::kHeading : Held::kNothing);
    });
  }
}

/// @returns the NIS of the sideways velocity, or 1 where nothing is said of it. That downwards has
/// humps in it that say nothing of the heading.
double VehicleAiding::roll(const ImuBlock& block, HeadingBank& bank) const {
  const Ekf& best = bank.best();
  if (!config_.non_holonomic || !best.vehicle()) return 1.0;
  const double speed_mps = best.estimate().nav.v_e_mps.norm();
  if (speed_mps < config_.min_speed_mps) return 1.0;
  const double turn_radps = (block.mean_omega_ib_b_radps - best.estimate().bias.b_g_radps).norm();
  double right_mps = right_sigma_mps(config_, turn_radps);
  if (!bank.collapsed()) {
    right_mps = std::hypot(right_mps, kOpenHeadingRightMps + kOpenHeadingRightM * turn_radps);
  }
  const auto constraint = [&](const Ekf& filter) {
    return non_holonomic(filter.estimate(), filter.vehicle()->value,
                         filter.inertial().omega_ib_b_radps(), right_mps,
                         down_sigma_mps(config_, speed_mps));
  };
  const double heading_mps =
      speed_mps *
      std::hypot(heading_sigma_rad(best), std::sqrt(best.vehicle()->P(kMountYaw, kMountYaw)));
  const double velocity_mps = std::sqrt(best.kernel().matrix().diagonal().segment<3>(kDv).sum());
  const double nis =
      std::pow(constraint(best).innovation(0), 2) /
      (right_mps * right_mps + heading_mps * heading_mps + velocity_mps * velocity_mps);
  bank.update([&](Ekf& filter) { return filter.update(constraint(filter)); });
  return nis;
}

}  // namespace leeway
