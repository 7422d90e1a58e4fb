/// @file
/// One drive for every benchmark of a filter: a circle at 20 m/s, lap after lap, sensors without
/// error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "leeway/model/error_state.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/navigator/navigator.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"

namespace leeway::test {

class Lap {
 public:
  static constexpr int kRateHz = 200;

  Estimate start() const {
    Estimate estimate;
    estimate.nav = sim::truth_at(circle_, 0.0).nav;
    return estimate;
  }

  /// The one that ends at k / kRateHz, k = 1, 2, ..
  ImuIncrement increment(std::int64_t k) const {
    ImuIncrement inc = increments_[static_cast<std::size_t>((k - 1) % kSteps)];
    inc.time = time(k);
    return inc;
  }

  /// Position and velocity at the end of that increment, or a while before.
  /// @param back  samples, whole ones and parts, at most k
  GnssFix fix(std::int64_t k, double back = 0.0) const {
    const double t_s = (static_cast<double>(k % kSteps) - back) / kRateHz;
    const NavState truth = sim::truth_at(circle_, t_s < 0.0 ? t_s + kLapS : t_s).nav;
    GnssFix fix;
    fix.time = time(k) - duration_from_seconds(back / kRateHz);
    fix.position = GnssPosition{truth.r_e_m, Eigen::Matrix3d::Identity()};
    fix.velocity = GnssVelocity{truth.v_e_mps, 0.01 * Eigen::Matrix3d::Identity()};
    return fix;
  }

  /// A filter that knows where it is.
  Ekf filter(const EkfConfig& config = {}) const {
    return Ekf(config, start(), covariance(config));
  }

  Navigator navigator(const NavigatorConfig& config = {}) const {
    Navigator navigator(config);
    navigator.start(start(), covariance(config.filter));
    return navigator;
  }

 private:
  static constexpr int kLapS = 20;
  static constexpr int kSteps = kLapS * kRateHz;

  static Time time(std::int64_t k) { return Time{} + k * duration_from_seconds(1.0 / kRateHz); }

  ErrorMatrix covariance(const EkfConfig& config) const {
    return initial_covariance(start(), {0.01, 0.05, 0.1, 3.0}, config.imu);
  }

  sim::Trajectory circle_{sim::circle({.radius_m = 20.0 * kLapS / (2.0 * std::numbers::pi),
                                       .speed_mps = 20.0,
                                       .duration_s = kLapS})};
  std::vector<ImuIncrement> increments_{sim::true_increments(circle_, kRateHz, kLapS)};
};

}  // namespace leeway::test
