/// @file
/// Filters in the middle of a run, for tests of what happens next.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "filters/recording.hpp"
#include "leeway/filters/ekf.hpp"
#include "leeway/sim/imu_simulator.hpp"

namespace leeway::test {

/// A filter on error-free data after some time of fixes every second, and the increments to come.
struct Settled {
  Ekf filter;
  std::vector<ImuIncrement> ahead;
};

/// The filter believes in the model; its estimate is the truth, so that what comes next is linear.
inline Settled settled(const sim::Trajectory& trajectory, const ImuErrorModel& imu, double settle_s,
                       double ahead_s, double rate_hz = 20.0) {
  EkfConfig config;
  config.imu = imu;
  config.gnss_correlation_s = 0.0;
  config.covariance_interval_s = 0.0;
  const Estimate start = truth_estimate(trajectory, 0.0);
  Ekf filter(config, start, initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, imu));
  std::vector<ImuIncrement> ahead;
  double next_fix_s = 1.0;
  for (const ImuIncrement& inc : sim::true_increments(trajectory, rate_hz, settle_s + ahead_s)) {
    const double t_s = to_seconds(inc.time);
    if (t_s > settle_s) {
      ahead.push_back(inc);
      continue;
    }
    filter.predict(inc);
    if (t_s < next_fix_s) continue;
    next_fix_s += 1.0;
    const NavState truth = sim::truth_at(trajectory, t_s).nav;
    GnssFix fix;
    fix.time = inc.time;
    fix.position = {truth.r_e_m, 4.0 * Eigen::Matrix3d::Identity()};
    fix.velocity = {truth.v_e_mps, 0.05 * 0.05 * Eigen::Matrix3d::Identity()};
    filter.update(fix);
  }
  return {filter, ahead};
}

}  // namespace leeway::test
