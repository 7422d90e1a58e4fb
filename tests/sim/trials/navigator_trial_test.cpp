#include <doctest/doctest.h>

#include <filesystem>

#include "leeway/sim/scene/scene_file.hpp"
#include "leeway/sim/trials/trial.hpp"

namespace leeway::sim {
namespace {

Scene short_town() {
  Scene scene = read_scene(std::filesystem::path(LEEWAY_SCENES_DIR) / "town-car.toml", 400.0);
  scene.gnss.interval_s = 5.0;
  return scene;
}

}  // namespace

TEST_CASE("a trial of the navigator aligns by itself, fuses, and is the same again") {
  const TrialPlan plan(short_town());
  const TrialScore score = run_trial(plan, 1);
  CHECK(score.finite);
  CHECK(!score.diverged);
  // A fix every second for 200 s, then one in 5 s. Those of the alignment are not fused.
  CHECK(score.epochs == 39);
  CHECK(score.fused > 200);
  CHECK(score.largest_horizontal_m < 30.0);
  const TrialScore again = run_trial(plan, 1);
  CHECK(again.error_sq_n_m2 == score.error_sq_n_m2);
  CHECK(again.nees == score.nees);
  CHECK(run_trial(plan, 2).error_sq_n_m2 != score.error_sq_n_m2);
}

TEST_CASE("no solution when a fix is scored is a trial that diverged") {
  Scene scene = short_town();
  scene.gnss.settle_s = 2.0;  // the car stands for 30 s: no heading, and no fix in between
  scene.gnss.interval_s = 190.0;
  scene.gnss.outages = {{0.0, 3.0}};
  const TrialScore score = run_trial(TrialPlan(scene), 1);
  CHECK(score.diverged);
}

TEST_CASE("a scene's own start errors start the navigator at once") {
  Scene scene = short_town();
  scene.initial = InitialSigma{0.003, 0.02, 0.1, 3.0};
  scene.gnss.settle_s = 0.0;
  scene.limit.last_s = 390.0;
  const TrialScore score = run_trial(TrialPlan(scene), 1);
  CHECK(score.epochs > 70);
  CHECK(!score.diverged);
}

}  // namespace leeway::sim
