#include <cmath>

#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/atlas/atlas.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kCorrelationS = 60.0;
constexpr double kCorrelatedSettledS = 120.0;

/// Fixes every second whose error wanders over a minute.
Scene wandering_fixes(double duration_s) {
  Scene scene;
  scene.name = "correlated fixes";
  scene.duration_s = duration_s;
  scene.trajectory = circle({.duration_s = duration_s});
  scene.imu_rate_hz = 20.0;
  set_imu(scene, "automotive-mems", automotive_mems_model());
  scene.gnss.errors.position_sigma_n_m.setConstant(0.5);
  scene.gnss.errors.correlated_sigma_n_m.setConstant(2.5);
  scene.gnss.errors.correlation_time_s = kCorrelationS;
  scene.initial =
      InitialSigma{.tilt_rad = 0.03, .heading_rad = 0.1, .velocity_mps = 0.1, .position_m = 2.5};
  return scene;
}

/// Error over claim, of the position alone.
double error_over_claim(WatchedFilter& filter, const RecordedTrial& trial) {
  double error_m2 = 0.0;
  double claimed_m2 = 0.0;
  replay(filter, trial, [&](const Estimate& truth, const WatchedFilter& now) {
    if (to_seconds(truth.nav.time) <= kCorrelatedSettledS || !now.has_estimate()) return;
    error_m2 += position_error_n_m(truth, now.estimate()).squaredNorm();
    if (const auto P = now.covariance()) claimed_m2 += P->block<3, 3>(kDr, kDr).trace();
  });
  return std::sqrt(error_m2 / claimed_m2);
}

std::vector<AtlasCell> run_correlated_fixes(const AtlasOptions& options) {
  const Scene scene = wandering_fixes(options.brief ? 300.0 : 600.0);
  const auto trials = recorded_trials(scene, options.brief ? 6 : 15);
  std::vector<AtlasCell> cells;
  for (const double correlation_s : {kCorrelationS, 0.0}) {
    EkfConfig believed = scene.filter;
    believed.gnss_correlation_s = correlation_s;
    const char* condition = correlation_s > 0.0 ? "correlation told" : "taken for white";
    for (AtlasCell& cell :
         scored(few_atlas_columns(), believed, trials, condition, error_over_claim)) {
      cells.push_back(std::move(cell));
    }
  }
  return cells;
}

}  // namespace

AtlasScene correlated_fixes() {
  return {.place = 70,
          .key = "correlated-fixes",
          .title = "Correlated fixes taken for white",
          .figure = "position error over its claimed sigma",
          .unit = "",
          .limits = {1.5, 2.5,
                     "of 1, by how much the mean over some minutes of a wandering error scatters; "
                     "beyond 2.5 sigma the claim of 95 % holds a third of the time"},
          .run = run_correlated_fixes};
}

}  // namespace leeway::sim::scenes
