#include <Eigen/Cholesky>
#include <cmath>

#include "leeway/model/heading.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "sim/atlas/watched_filter.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kStillRateHz = 1000.0;
constexpr double kDurationS = 20.0;

/// White noise alone, 0.3 deg/sqrt(h); biases so small that they add nothing.
ImuErrorModel noisy_gyro() {
  ImuErrorModel imu;
  imu.accelerometer.bias_sigma = 1e-6;
  imu.gyro.bias_sigma = 1e-9;
  imu.gyro.noise_density = automotive_mems_model().gyro.noise_density;
  return imu;
}

TrialStart start_with_heading(const Trajectory& trajectory, double sigma_rad) {
  TrialStart start;
  start.estimate.nav = truth_at(trajectory, 0.0).nav;
  // The same about every axis: turning with the Earth it stays what it is.
  start.P = initial_covariance(
      start.estimate,
      {.tilt_rad = sigma_rad, .heading_rad = sigma_rad, .velocity_mps = 0.1, .position_m = 1.0},
      noisy_gyro());
  return start;
}

std::vector<Variant> variants_by_interval() {
  std::vector<Variant> variants;
  for (const Variant& v : covariance_variants()) {
    if (v.update == UpdateForm::kJoseph) variants.push_back(v);
  }
  return variants;
}

/// Of the heading's variance, what has come to it over what the noise brings, less one: all of the
/// noise is lost at 1.
double share_lost(WatchedFilter& filter, const std::vector<ImuIncrement>& imu) {
  const auto variance = [&filter] {
    return heading_variance_rad2(filter.estimate(), *filter.covariance());
  };
  const double before = variance();
  for (const ImuIncrement& inc : imu) filter.predict(inc);
  const double density = noisy_gyro().gyro.noise_density;
  const double brought = density * density * to_seconds(imu.back().time);
  return std::abs((variance() - before) / brought - 1.0);
}

/// As far from the estimate as both let expect: a NIS of 3.
GnssFix fix_beside(const Estimate& estimate, const ErrorMatrix& P) {
  const Eigen::Matrix3d R_m2 = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d S_m2 = P.block<3, 3>(kDr, kDr) + R_m2;
  GnssFix fix;
  fix.time = estimate.nav.time;
  fix.position = {estimate.nav.r_e_m + S_m2.llt().matrixL() * Eigen::Vector3d::Ones(), R_m2};
  return fix;
}

/// RMS over starts that differ a little: each rounds otherwise.
AtlasCell cell_of(const AtlasColumn& column, const Trajectory& rest,
                  const std::vector<ImuIncrement>& imu, int starts) {
  AtlasCell cell{column.group, column.name};
  for (int k = 0; k < starts; ++k) {
    const double sigma_rad = (1.0 + 0.1 * k) * kRadPerDeg;
    const auto filter = column.make({.imu = noisy_gyro(), .gnss_correlation_s = 0.0},
                                    start_with_heading(rest, sigma_rad));
    const double share = share_lost(*filter, imu);
    cell.figure += share * share / starts;
    // Detectors are asked at a fix.
    filter->update(fix_beside(filter->estimate(), *filter->covariance()));
    cell.reported = joined(filter->reported());
  }
  cell.figure = std::sqrt(cell.figure);
  return cell;
}

std::vector<AtlasCell> run_lost_noise(const AtlasOptions& options) {
  const Trajectory rest = static_trajectory({.duration_s = kDurationS});
  const auto imu = true_increments(rest, kStillRateHz, kDurationS);
  std::vector<AtlasCell> cells;
  for (const Variant& variant : variants_by_interval()) {
    cells.push_back(cell_of(column_of(variant), rest, imu, options.brief ? 2 : 6));
  }
  return cells;
}

}  // namespace

AtlasScene lost_noise() {
  return {.place = 30,
          .key = "lost-noise",
          .title = "Process noise lost to rounding",
          .figure = "heading variance that is missing or invented, over what the gyro noise brings",
          .limits = {0.1, 0.5,
                     "a tenth of the noise is 5 % of its sigma; without half of it, or with half "
                     "more, the noise that was configured is another one"},
          .run = run_lost_noise};
}

}  // namespace leeway::sim::scenes
