#include <cmath>
#include <numbers>
#include <string>

#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kSettleS = 300.0;
constexpr double kCoastS = 3600.0;
constexpr double kStaleFixM = 1.0;

/// Five minutes of fixes, an hour of none, then 20 fixes.
Scene hour_without_fixes() {
  // A lap a minute: the motion of one is all there is to compute.
  constexpr double kRadiusM = 200.0;
  Scene scene = drive_scene(
      circle({.radius_m = kRadiusM,
              .speed_mps = 2.0 * std::numbers::pi * kRadiusM / 60.0,
              .duration_s = kSettleS + kCoastS + 20.0}),
      10.0,
      {.tilt_rad = 1e-3, .heading_rad = 0.02, .velocity_mps = 0.1, .position_m = kStaleFixM},
      imu_class_model(ImuClass::kTactical, RangeEnd::kHigh));
  scene.gnss.errors.position_sigma_n_m.setConstant(kStaleFixM);
  scene.gnss.outages = {{kSettleS, kCoastS}};
  return scene;
}

/// So long after the first of the late fixes.
double error_after_late_fix_m(WatchedFilter& filter, const RecordedTrial& trial, double after_s) {
  const double t0_s = kSettleS + kCoastS + 1.0 + after_s;
  ErrorSums sums;
  replay(filter, trial, [&](const Estimate& truth, const WatchedFilter& now) {
    if (std::abs(to_seconds(truth.nav.time) - t0_s) < 0.5) sums.add(truth, now);
  });
  return sums.horizontal_rms_m();
}

std::vector<AtlasCell> run_stale_covariance(const AtlasOptions& options) {
  const Scene scene = hour_without_fixes();
  const auto trials = recorded_trials(scene, options.brief ? 1 : 8);
  return cells_over(std::vector{1.0, 19.0}, [&](double after_s) {
    return scored(few_atlas_columns(), scene.filter, trials,
                  std::to_string(std::lround(after_s)) + " s later",
                  [after_s](WatchedFilter& filter, const RecordedTrial& trial) {
                    return error_after_late_fix_m(filter, trial, after_s);
                  });
  });
}

}  // namespace

AtlasScene stale_covariance() {
  return {.place = 80,
          .key = "stale-covariance",
          .title = "One fix after an hour of coasting",
          .figure = "horizontal error after the first late fix",
          .unit = "m",
          .limits = {4.0, 100.0,
                     "three sigma of a 1 m fix and a second of motion; at 100 m the fix did not "
                     "bring the estimate back"},
          .run = run_stale_covariance};
}

}  // namespace leeway::sim::scenes
