/// @file
/// Filters in the middle of a run, for tests of what happens next.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <vector>

#include "leeway/ekf/ekf.hpp"
#include "leeway/model/error_metric.hpp"
#include "leeway/model/horizontal.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "tests/filters/navigator/recording.hpp"

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

/// Of a covariance along north, east and down, and a course over ground in rad.
using Metric = std::function<double(const Eigen::Matrix3d&, double)>;

inline Metric radius(double probability) {
  return [=](const Eigen::Matrix3d& P, double) {
    return horizontal_radius_m(P.topLeftCorner<2, 2>(), probability);
  };
}

inline Metric metric(ErrorMetric which) {
  return [=](const Eigen::Matrix3d& P, double course_rad) {
    return error_size_m(which, P, course_rad);
  };
}

inline double present(const Ekf& filter, const Metric& size) {
  const NavState& nav = filter.estimate().nav;
  return size(ned_covariance(nav.r_e_m, filter.covariance().block<3, 3>(kDr, kDr)),
              course_over_ground_rad(nav));
}

/// How large the error is while the filter coasts over the increments ahead, and when.
struct Coast {
  std::vector<double> t_s;
  std::vector<double> size_m;

  /// The first time above the limit, between samples as of a power of time; NaN if never.
  double first_crossing_s(double limit_m) const {
    for (std::size_t k = 1; k < t_s.size(); ++k) {
      if (!(size_m[k] > limit_m)) continue;
      const double part = std::log(limit_m / size_m[k - 1]) / std::log(size_m[k] / size_m[k - 1]);
      return t_s[k - 1] + part * (t_s[k] - t_s[k - 1]);
    }
    return std::numeric_limits<double>::quiet_NaN();
  }
};

inline Coast coast(const Settled& run, const Metric& size, std::size_t every = 1) {
  Ekf filter = run.filter;
  const double start_s = to_seconds(filter.estimate().nav.time);
  Coast result{{0.0}, {present(filter, size)}};
  for (std::size_t k = 0; k < run.ahead.size(); ++k) {
    filter.predict(run.ahead[k]);
    if ((k + 1) % every != 0) continue;
    result.t_s.push_back(to_seconds(run.ahead[k].time) - start_s);
    result.size_m.push_back(present(filter, size));
  }
  return result;
}

}  // namespace leeway::test
