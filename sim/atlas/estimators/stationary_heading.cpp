#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

struct RestingImu {
  const char* name;
  ImuErrorModel model;
};

/// At rest with ordinary fixes. Only a gyro that feels the Earth turn tells the heading.
Scene at_rest(const RestingImu& imu) {
  return drive_scene(static_trajectory({.duration_s = 600.0}), 5.0,
                     {.tilt_rad = 0.01,
                      .heading_rad = 10.0 * kRadPerDeg,
                      .velocity_mps = 0.05,
                      .position_m = 2.5},
                     imu.model);
}

std::vector<AtlasCell> run_stationary_heading(const AtlasOptions& options) {
  const std::vector<RestingImu> imus{
      {"automotive-mems", automotive_mems_model()},
      {"marine", imu_class_model(ImuClass::kMarine, RangeEnd::kMid)}};
  return cells_over(imus, [&](const RestingImu& imu) {
    const Scene scene = at_rest(imu);
    return scored(few_atlas_columns(), scene.filter,
                  recorded_trials(scene, options.brief ? 6 : 24), imu.name,
                  final_heading_over_claim);
  });
}

}  // namespace

AtlasScene stationary_heading() {
  return {
      .place = 50,
      .key = "stationary-heading",
      .title = "Heading at rest",
      .figure = "heading error over its claimed sigma after ten minutes",
      .limits =
          {1.5, 3.0,
           "of 1, by how much two dozen trials scatter; at 3 the heading was learned from noise"},
      .run = run_stationary_heading};
}

}  // namespace leeway::sim::scenes
