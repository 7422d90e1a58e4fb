#include <cmath>
#include <string>

#include "leeway/earth/earth.hpp"
#include "leeway/sim/atlas/atlas.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kUniformSigmaRad = 1.81;  // of a heading that is anywhere: pi / sqrt(3)
constexpr double kScoredLastS = 20.0;

Scene town_drive() {
  return car_grade_scene(
      "heading unknown", car_drive({.initial_rest_s = 2.0, .duration_s = 120.0}), 120.0, 25.0,
      {.tilt_rad = 0.03, .heading_rad = 1e-3, .velocity_mps = 0.1, .position_m = 2.5});
}

/// The trial begun with a heading that is off by so much, and said to be anywhere.
RecordedTrial with_heading_off(const RecordedTrial& trial, double off_rad) {
  RecordedTrial off = trial;
  const Eigen::Vector3d down_e = down_e_at(trial.start.estimate.nav.r_e_m);
  ErrorVector turn = ErrorVector::Zero();
  turn.segment<3>(kPsi) = off_rad * down_e;
  inject(off.start.estimate, turn);
  off.start.P.block<3, 3>(kPsi, kPsi) +=
      kUniformSigmaRad * kUniformSigmaRad * down_e * down_e.transpose();
  return off;
}

double late_heading_error_deg(WatchedFilter& filter, const RecordedTrial& trial) {
  const double from_s = to_seconds(trial.imu.back().time) - kScoredLastS;
  double sum_rad2 = 0.0;
  double fixes = 0.0;
  replay(filter, trial, [&](const Estimate& truth, const WatchedFilter& now) {
    if (to_seconds(truth.nav.time) < from_s || !now.has_estimate()) return;
    sum_rad2 += std::pow(heading_error_rad(truth, now.estimate()), 2);
    fixes += 1.0;
  });
  return std::sqrt(sum_rad2 / fixes) / kRadPerDeg;
}

std::vector<AtlasCell> run_wrong_heading(const AtlasOptions& options) {
  const Scene scene = town_drive();
  const auto trials = recorded_trials(scene, options.brief ? 2 : 5);
  std::vector<AtlasCell> cells;
  for (const double off_deg : {0.0, 30.0, 90.0, 135.0, 180.0}) {
    std::vector<RecordedTrial> off;
    for (const RecordedTrial& trial : trials) {
      off.push_back(with_heading_off(trial, off_deg * kRadPerDeg));
    }
    const std::string condition = std::to_string(std::lround(off_deg)) + " deg";
    for (AtlasCell& cell :
         scored(few_atlas_columns(), scene.filter, off, condition, late_heading_error_deg)) {
      cells.push_back(std::move(cell));
    }
  }
  return cells;
}

}  // namespace

AtlasScene wrong_heading() {
  return {.place = 60,
          .key = "wrong-heading",
          .title = "A heading that is off by up to half a turn",
          .figure = "RMS heading error over the last 20 s of two minutes in town",
          .unit = "deg",
          .limits = {5.0, 20.0,
                     "what a car in town allows a MEMS unit with a right start; from 20 deg on one "
                     "linearized filter does not find back by itself"},
          .run = run_wrong_heading};
}

}  // namespace leeway::sim::scenes
