#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

Scene parked(double duration_s) {
  Scene scene = drive_scene(static_trajectory({.duration_s = duration_s}), 5.0,
                            {.tilt_rad = 0.03,
                             .heading_rad = 10.0 * kRadPerDeg,
                             .velocity_mps = 0.05,
                             .position_m = 0.1});
  scene.gnss.errors.position_sigma_n_m.setConstant(0.01);
  scene.gnss.errors.velocity_sigma_n_mps.setConstant(0.01);
  return scene;
}

std::vector<AtlasCell> run_parked_rtk(const AtlasOptions& options) {
  const Scene scene = parked(options.brief ? 300.0 : 900.0);
  return scored(few_atlas_columns(), scene.filter, recorded_trials(scene, options.brief ? 6 : 24),
                {}, final_heading_over_claim);
}

}  // namespace

AtlasScene parked_rtk() {
  return {.place = 40,
          .key = "parked-rtk",
          .title = "Parked with RTK fixes: the heading's variance collapses",
          .figure = "heading error over its claimed sigma at the end",
          .limits = {1.5, 3.0,
                     "of 1, by how much two dozen trials scatter; a claim of a third of the error "
                     "keeps a later filter from learning the heading"},
          .run = run_parked_rtk};
}

}  // namespace leeway::sim::scenes
