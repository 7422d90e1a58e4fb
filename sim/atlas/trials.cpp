#include "sim/atlas/trials.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "leeway/earth/earth.hpp"
#include "leeway/ekf/ekf_config.hpp"
#include "leeway/model/horizontal.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/trials/player.hpp"

namespace leeway::sim {
namespace {

constexpr double kNoFigure = std::numeric_limits<double>::infinity();

double root_of_mean(double sum, double epochs) { return std::sqrt(sum / epochs); }

/// The names that both have.
Reports common(const Reports& a, const Reports& b) {
  Reports both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::inserter(both, both.end()));
  return both;
}

AtlasCell scored_column(const AtlasColumn& column, const EkfConfig& believed,
                        const std::vector<RecordedTrial>& trials, const std::string& condition,
                        const Score& score) {
  AtlasCell cell{column.group, column.name, condition};
  std::vector<std::pair<double, Reports>> outcomes;
  for (const RecordedTrial& trial : trials) {
    const auto filter = column.make(believed, trial.start);
    const double figure = score(*filter, trial);
    outcomes.emplace_back(figure, filter->reported());
    cell.figure += figure * figure;
  }
  cell.figure = root_of_mean(cell.figure, static_cast<double>(trials.size()));
  // Rounding must not leave out trials that are all alike.
  const double bad = cell.figure * (1.0 - 1e-9);
  std::optional<Reports> reports;
  for (const auto& [figure, said] : outcomes) {
    if (figure < bad) continue;
    reports = reports ? common(*reports, said) : said;
  }
  if (reports) cell.reported = joined(*reports);
  return cell;
}

}  // namespace

Scene drive_scene(const Trajectory& trajectory, double imu_rate_hz, const InitialSigma& initial,
                  const ImuErrorModel& imu) {
  Scene scene;
  scene.name = trajectory.name;
  scene.trajectory = trajectory;
  scene.duration_s = std::floor(trajectory.duration_s);
  scene.imu_rate_hz = imu_rate_hz;
  set_imu(scene, "of the atlas", imu);
  scene.filter.gnss_correlation_s = 0.0;
  scene.initial = initial;
  return scene;
}

Scene town_drive(double duration_s) {
  return drive_scene(
      square_loop({.straight_s = 10.0, .duration_s = duration_s}), 100.0,
      {.tilt_rad = 0.01, .heading_rad = 0.05, .velocity_mps = 0.1, .position_m = 3.0});
}

std::vector<RecordedTrial> recorded_trials(const Scene& scene, int n) {
  const TrialPlan plan(scene, scene.duration_s, 1);
  std::vector<RecordedTrial> trials;
  for (int seed = 1; seed <= n; ++seed) {
    trials.push_back(record_trial(plan, static_cast<std::uint64_t>(seed)));
  }
  return trials;
}

Spoil each_increment(std::function<void(ImuIncrement&)> spoil) {
  return [spoil = std::move(spoil)](RecordedTrial& trial) {
    for (ImuIncrement& inc : trial.imu) spoil(inc);
  };
}

Spoil each_fix(std::function<void(GnssFix&)> spoil) {
  return [spoil = std::move(spoil)](RecordedTrial& trial) {
    for (RecordedTrial::Fix& fix : trial.fixes) spoil(fix.fix);
  };
}

std::vector<RecordedTrial> spoiled(std::vector<RecordedTrial> trials, const Spoil& spoil) {
  for (RecordedTrial& trial : trials) spoil(trial);
  return trials;
}

void replay(WatchedFilter& filter, const RecordedTrial& trial, const BeforeFix& before_fix) {
  play(
      trial.imu.size(), 1, trial.fixes, [&](std::size_t k) { filter.predict(trial.imu[k]); },
      [&](const RecordedTrial::Fix& fix) {
        if (before_fix && fix.truth) before_fix(*fix.truth, filter);
        filter.update(fix.fix);
      },
      [](const RecordedTrial::Fix&) {});
}

std::vector<AtlasCell> scored(const std::vector<AtlasColumn>& columns, const EkfConfig& believed,
                              const std::vector<RecordedTrial>& trials,
                              const std::string& condition, const Score& score) {
  std::vector<AtlasCell> cells;
  for (const AtlasColumn& column : columns) {
    cells.push_back(scored_column(column, believed, trials, condition, score));
  }
  return cells;
}

void ErrorSums::add(const Estimate& truth, const WatchedFilter& filter) {
  if (!filter.has_estimate()) {
    finite = false;
    return;
  }
  const Estimate estimate = filter.estimate();
  const auto P = filter.covariance();
  TrialScore one;
  score_epoch(one, truth, estimate, P ? &*P : nullptr);
  nees += P && one.finite ? one.nees : std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d error_n_m = position_error_n_m(truth, estimate);
  finite = finite && error_n_m.allFinite();
  if (!finite) return;
  epochs += 1.0;
  position_m2 += error_n_m.squaredNorm();
  horizontal_m2 += error_n_m.head<2>().squaredNorm();
}

double ErrorSums::position_rms_m() const {
  return finite ? root_of_mean(position_m2, epochs) : kNoFigure;
}

double ErrorSums::horizontal_rms_m() const {
  return finite ? root_of_mean(horizontal_m2, epochs) : kNoFigure;
}

double ErrorSums::sigma_ratio() const {
  const double ratio = root_of_mean(nees, kErrorStates * epochs);
  return finite && std::isfinite(ratio) ? ratio : kNoFigure;
}

ErrorSums errors_after(WatchedFilter& filter, const RecordedTrial& trial, double from_s) {
  ErrorSums sums;
  replay(filter, trial, [&](const Estimate& truth, const WatchedFilter& now) {
    if (to_seconds(truth.nav.time) > from_s) sums.add(truth, now);
  });
  return sums;
}

Score score_after(double from_s, double (ErrorSums::*figure)() const) {
  return [from_s, figure](WatchedFilter& filter, const RecordedTrial& trial) {
    return (errors_after(filter, trial, from_s).*figure)();
  };
}

double final_heading_over_claim(WatchedFilter& filter, const RecordedTrial& trial) {
  double ratio = kNoFigure;
  replay(filter, trial, [&ratio](const Estimate& truth, const WatchedFilter& now) {
    ratio = kNoFigure;
    if (!now.has_estimate()) return;
    const auto sigma_rad = now.heading_sigma_rad();
    if (sigma_rad) ratio = heading_error_rad(truth, now.estimate()) / *sigma_rad;
  });
  return ratio;
}

double claimed_horizontal_m2(const Estimate& truth, const ErrorMatrix& P) {
  return horizontal_covariance(truth.nav.r_e_m, P.block<3, 3>(kDr, kDr)).trace();
}

double heading_error_rad(const Estimate& truth, const Estimate& estimate) {
  const Eigen::Vector3d psi_e = difference(truth, estimate).segment<3>(kPsi);
  return std::abs(psi_e.dot(down_e_at(truth.nav.r_e_m)));
}

}  // namespace leeway::sim
