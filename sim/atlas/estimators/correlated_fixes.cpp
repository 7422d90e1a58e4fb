#include <cmath>

#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kCorrelationS = 60.0;
constexpr double kCorrelatedSettledS = 120.0;

/// Fixes every second whose error wanders over a minute.
Scene wandering_fixes(double duration_s) {
  Scene scene = drive_scene(circle({.duration_s = duration_s}), 20.0);
  scene.gnss.errors.position_sigma_n_m.setConstant(0.5);
  scene.gnss.errors.correlated_sigma_n_m.setConstant(2.5);
  scene.gnss.errors.correlation_time_s = kCorrelationS;
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
  EkfConfig told = scene.filter;
  told.gnss_correlation_s = kCorrelationS;
  auto cells = scored(few_atlas_columns(), told, trials, "correlation told", error_over_claim);
  append(cells,
         scored(few_atlas_columns(), scene.filter, trials, "taken for white", error_over_claim));
  return cells;
}

}  // namespace

AtlasScene correlated_fixes() {
  return {.place = 70,
          .key = "correlated-fixes",
          .title = "Correlated fixes taken for white",
          .figure = "position error over its claimed sigma",
          .limits = {1.5, 2.5,
                     "of 1, by how much the mean over some minutes of a wandering error scatters; "
                     "beyond 2.5 sigma the claim of 95 % holds a third of the time"},
          .run = run_correlated_fixes};
}

}  // namespace leeway::sim::scenes
