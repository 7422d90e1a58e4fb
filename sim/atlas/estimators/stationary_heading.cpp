#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/atlas/atlas.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

struct RestingImu {
  const char* name;
  ImuErrorModel model;
};

std::vector<RestingImu> resting_imus() {
  return {{"automotive-mems", automotive_mems_model()},
          {"marine", imu_class_model(ImuClass::kMarine, RangeEnd::kMid)}};
}

/// At rest with ordinary fixes. Only a gyro that feels the Earth turn tells the heading.
Scene at_rest(const RestingImu& imu) {
  Scene scene;
  scene.name = "heading at rest";
  scene.duration_s = 600.0;
  scene.trajectory = static_trajectory({.duration_s = scene.duration_s});
  scene.imu_rate_hz = 5.0;
  set_imu(scene, imu.name, imu.model);
  scene.filter.gnss_correlation_s = 0.0;
  scene.initial = InitialSigma{
      .tilt_rad = 0.01, .heading_rad = 10.0 * kRadPerDeg, .velocity_mps = 0.05, .position_m = 2.5};
  return scene;
}

std::vector<AtlasCell> run_stationary_heading(const AtlasOptions& options) {
  std::vector<AtlasCell> cells;
  for (const RestingImu& imu : resting_imus()) {
    const Scene scene = at_rest(imu);
    const auto trials = recorded_trials(scene, options.brief ? 6 : 24);
    for (AtlasCell& cell :
         scored(few_atlas_columns(), scene.filter, trials, imu.name, final_heading_over_claim)) {
      cells.push_back(std::move(cell));
    }
  }
  return cells;
}

}  // namespace

AtlasScene stationary_heading() {
  return {
      .place = 50,
      .key = "stationary-heading",
      .title = "Heading at rest",
      .figure = "heading error over its claimed sigma after ten minutes",
      .unit = "",
      .limits =
          {1.5, 3.0,
           "of 1, by how much two dozen trials scatter; at 3 the heading was learned from noise"},
      .run = run_stationary_heading};
}

}  // namespace leeway::sim::scenes
