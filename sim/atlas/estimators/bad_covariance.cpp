#include <Eigen/LU>
#include <limits>

#include "leeway/earth/earth.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kOffM = 100.0;  // the fix with the bad covariance is so far north

/// A covariance that a receiver must not report, or that says: this fix is worth nothing.
struct BadCovariance {
  const char* name;
  Eigen::Matrix3d R_e_m2;
};

std::vector<BadCovariance> bad_covariances() {
  const Eigen::Matrix3d right = 6.25 * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d indefinite = right;
  indefinite(0, 1) = indefinite(1, 0) = 2.0 * right(0, 0);
  Eigen::Matrix3d asymmetric = right;
  asymmetric(0, 1) = right(0, 0);
  const Eigen::Matrix3d nan = Eigen::Matrix3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return {
      {"zero", Eigen::Matrix3d::Zero()},     {"negative", -right},       {"NaN", nan},
      {"not positive definite", indefinite}, {"asymmetric", asymmetric}, {"huge", 1e12 * right}};
}

/// The same drive, its last fix with this covariance and far away.
RecordedTrial with_bad_last(const RecordedTrial& trial, const Eigen::Matrix3d& R_e_m2) {
  RecordedTrial bad = trial;
  GnssFix& last = bad.fixes.back().fix;
  last.velocity.reset();
  last.position->R_e_m2 = R_e_m2;
  last.position->r_e_m += kOffM * ned_to_ecef(geodetic_from_ecef(last.position->r_e_m)).col(0);
  return bad;
}

/// How far the last fix takes the estimate.
double pulled_m(WatchedFilter& filter, const RecordedTrial& trial) {
  Eigen::Vector3d before_e_m = Eigen::Vector3d::Zero();
  replay(filter, trial, [&before_e_m](const Estimate&, const WatchedFilter& now) {
    before_e_m = now.estimate().nav.r_e_m;
  });
  return (filter.estimate().nav.r_e_m - before_e_m).norm();
}

/// P H^T (H P H^T + R)^-1 z with whatever R there is.
double pulled_unchecked_m(const AtlasColumn& column, const EkfConfig& believed,
                          const RecordedTrial& trial) {
  RecordedTrial before = trial;
  before.fixes.pop_back();
  const auto filter = column.make(believed, trial.start);
  replay(*filter, before);
  const Measurement m = gnss_measurement(trial.fixes.back().fix, filter->estimate(),
                                         Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
  const Eigen::Matrix<double, 3, kErrorStates> H = m.H;  // the fix has no velocity
  const Eigen::Matrix<double, kErrorStates, 3> PHt =
      filter->covariance()->lazyProduct(H.transpose());
  const Eigen::Matrix3d S = H.lazyProduct(PHt) + m.R;
  const Eigen::Vector3d whole = S.inverse() * m.innovation;
  const ErrorVector x = PHt * whole;
  return x.segment<3>(kDr).norm();
}

std::vector<AtlasCell> run_bad_covariance(const AtlasOptions& /*options*/) {
  const Scene scene = drive_scene(circle({.duration_s = 30.0}), 20.0);
  const auto trials = recorded_trials(scene, 1);
  return cells_over(bad_covariances(), [&](const BadCovariance& bad) {
    const RecordedTrial trial = with_bad_last(trials.front(), bad.R_e_m2);
    auto cells = scored(atlas_columns(), scene.filter, {trial}, bad.name, pulled_m);
    cells.push_back({AtlasGroup::kNotOffered, "R taken as it comes", bad.name,
                     pulled_unchecked_m(column_of({}), scene.filter, trial)});
    return cells;
  });
}

}  // namespace

AtlasScene bad_covariance() {
  return {.place = 150,
          .key = "bad-covariance",
          .title = "A fix with a covariance that is none",
          .figure = "how far a fix 100 m off takes the estimate",
          .unit = "m",
          .limits = {0.01, 1.0,
                     "the fix must be refused or weigh nothing; a centimetre is below all that a "
                     "filter claims here, a metre is not"},
          .run = run_bad_covariance};
}

}  // namespace leeway::sim::scenes
