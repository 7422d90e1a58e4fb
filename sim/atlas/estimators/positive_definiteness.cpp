#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kPreciseFixM = 0.01;
constexpr double kVagueSettledS = 30.0;

/// At rest. The first fix shrinks the variance of the position by 1e10, which float has no digits
/// for.
Scene kilometre_prior() {
  Scene scene = drive_scene(
      static_trajectory({.duration_s = 60.0}), 20.0,
      {.tilt_rad = 0.03, .heading_rad = 0.1, .velocity_mps = 0.1, .position_m = 1000.0});
  scene.gnss.errors.position_sigma_n_m.setConstant(kPreciseFixM);
  return scene;
}

double settled_error_over_fix(WatchedFilter& filter, const RecordedTrial& trial) {
  return errors_after(filter, trial, kVagueSettledS).position_rms_m() / kPreciseFixM;
}

std::vector<AtlasCell> run_positive_definiteness(const AtlasOptions& options) {
  const Scene scene = kilometre_prior();
  return scored(atlas_columns(), scene.filter, recorded_trials(scene, options.brief ? 2 : 10), {},
                settled_error_over_fix);
}

}  // namespace

AtlasScene positive_definiteness() {
  return {.place = 10,
          .key = "positive-definiteness",
          .title = "A kilometre of prior, a centimetre of fix",
          .figure = "RMS position error before fixes, over the sigma of a fix",
          .limits = {3.0, 100.0,
                     "a second after a fix the error is that of fix and filter together, within 3 "
                     "sigma of the fix; at 100 sigma the fixes are as good as unused"},
          .run = run_positive_definiteness};
}

}  // namespace leeway::sim::scenes
