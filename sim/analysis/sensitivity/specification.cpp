#include "leeway/sim/analysis/specification.hpp"

#include <algorithm>

namespace leeway::sim {
namespace {

/// Calls f with the deviation of each element from the identity, on the diagonal or off it.
template <class F>
void each_deviation(Eigen::Matrix3d& M, bool on_diagonal, F&& f) {
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      if ((row == column) != on_diagonal) continue;
      const double ideal = on_diagonal ? 1.0 : 0.0;
      double deviation = M(row, column) - ideal;
      f(deviation);
      M(row, column) = ideal + deviation;
    }
  }
}

/// @param specification  of the accelerometer, whose order the gyro's have too
template <class F>
void each_number(TriadErrorModel& triad, Specification specification, F&& f) {
  using enum Specification;
  switch (specification) {
    case kAccelerometerBias:
      std::ranges::for_each(triad.bias.reshaped(), f);
      f(triad.bias_sigma);
      break;
    case kAccelerometerDrift:
      f(triad.in_run.sigma);
      break;
    case kAccelerometerNoise:
      f(triad.noise_density);
      break;
    case kAccelerometerScale:
      each_deviation(triad.M, true, f);
      f(triad.scale_sigma);
      break;
    default:
      each_deviation(triad.M, false, f);
      f(triad.misalignment_sigma_rad);
  }
}

template <class F>
void each_number(ImuErrorModel& imu, Specification specification, F&& f) {
  using enum Specification;
  if (specification == kGyroGSensitivity) {
    std::ranges::for_each(imu.G_g_radps_per_mps2.reshaped(), f);
    f(imu.G_g_sigma_radps_per_mps2);
  } else if (specification >= kGyroBias) {
    const int index = static_cast<int>(specification) - static_cast<int>(kGyroBias);
    each_number(imu.gyro, static_cast<Specification>(index), f);
  } else {
    each_number(imu.accelerometer, specification, f);
  }
}

template <class F>
void each_number(SceneVehicle& vehicle, Specification specification, F&& f) {
  using enum Specification;
  VehicleConfig& config = vehicle.config;
  if (specification == kStandstill && config.zero_velocity) f(config.rest_sigma_mps);
  if (specification == kStandstill && config.zero_angular_rate) f(config.rest_turn_sigma_radps);
  if (specification == kNoSideSlip && config.non_holonomic) {
    f(config.right_sigma_mps);
    f(config.right_sigma_m);
    f(config.down_sigma_m2ps2);
  }
  if (specification == kOdometer && vehicle.odometer) {
    f(vehicle.odometer->sigma);
    f(config.odometer_scale_sigma);
    f(config.odometer_walk_per_sqrt_s);
  }
  if (specification == kBarometer && vehicle.barometer) {
    f(vehicle.barometer->sigma);
    f(config.height_offset_sigma_m);
    f(config.height_walk_m_per_sqrt_s);
  }
  if (specification == kHeading && vehicle.heading) f(vehicle.heading->sigma);
}

/// Calls f with each number that a specification consists of.
template <class F>
void each_number(Scene& scene, Specification specification, F&& f) {
  using enum Specification;
  GnssErrorModel& gnss = scene.gnss.errors;
  if (is_of_imu(specification)) {
    each_number(scene.imu, specification, f);
    each_number(scene.filter.imu, specification, f);
    return;
  }
  switch (specification) {
    case kGnssPosition:
      std::ranges::for_each(gnss.position_sigma_n_m.reshaped(), f);
      return;
    case kGnssCorrelated:
      std::ranges::for_each(gnss.correlated_sigma_n_m.reshaped(), f);
      return;
    case kGnssVelocity:
      std::ranges::for_each(gnss.velocity_sigma_n_mps.reshaped(), f);
      return;
    case kGnssCorrelationTime:
      if (gnss.correlated_sigma_n_m.isZero(0.0)) return;
      f(gnss.correlation_time_s);
      f(scene.filter.gnss_correlation_s);
      return;
    default:
      if (scene.vehicle) each_number(*scene.vehicle, specification, f);
  }
}

}  // namespace

bool has(const Scene& scene, Specification specification) {
  Scene copy = scene;
  bool any = false;
  each_number(copy, specification, [&any](double& number) { any = any || number != 0.0; });
  return any;
}

std::vector<Specification> specifications(const Scene& scene) {
  std::vector<Specification> all;
  std::ranges::copy_if(kAll<Specification>, std::back_inserter(all),
                       [&scene](Specification s) { return has(scene, s); });
  return all;
}

Scene scaled(Scene scene, Specification specification, double factor) {
  each_number(scene, specification, [factor](double& number) { number *= factor; });
  return scene;
}

std::optional<ErrorSource> source_of(Specification specification) {
  for (const ErrorSource source : kAll<ErrorSource>) {
    if (name(source) == name(specification)) return source;
  }
  return {};
}

}  // namespace leeway::sim
