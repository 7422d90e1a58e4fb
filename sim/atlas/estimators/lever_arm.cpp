#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kSpinFixM = 0.02;

/// A vehicle that turns once in 6 s, its antenna 2 m ahead of the IMU and 1 m above.
Scene spinning(double duration_s) {
  Scene scene = drive_scene(
      circle({.radius_m = 5.0, .speed_mps = 5.0, .duration_s = duration_s}), 50.0,
      {.tilt_rad = 0.03, .heading_rad = 0.1, .velocity_mps = 0.1, .position_m = 0.1});
  scene.gnss.errors.position_sigma_n_m.setConstant(kSpinFixM);
  scene.gnss.errors.lever_arm_b_m = {2.0, 0.0, -1.0};
  scene.filter.lever_arm_b_m = scene.gnss.errors.lever_arm_b_m;
  return scene;
}

std::vector<AtlasCell> run_lever_arm(const AtlasOptions& options) {
  const Scene scene = spinning(options.brief ? 40.0 : 60.0);
  const auto trials = recorded_trials(scene, options.brief ? 2 : 8);
  const Score error_m = score_after(20.0, &ErrorSums::position_rms_m);
  EkfConfig ignorant = scene.filter;
  ignorant.lever_arm_b_m.setZero();
  auto cells = scored(few_atlas_columns(), scene.filter, trials, "known", error_m);
  append(cells, scored(few_atlas_columns(), ignorant, trials, "ignored", error_m));
  return cells;
}

}  // namespace

AtlasScene lever_arm() {
  return {.place = 130,
          .key = "lever-arm",
          .title = "A lever arm ignored while spinning",
          .figure = "RMS position error before fixes",
          .unit = "m",
          .limits = {0.2, 1.0,
                     "a second of MEMS after a fix of 2 cm is good to a decimetre or two; beyond 1 "
                     "m the fix is not used to a fiftieth of its worth"},
          .run = run_lever_arm};
}

}  // namespace leeway::sim::scenes
