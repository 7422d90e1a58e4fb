#include <cmath>
#include <string>

#include "leeway/earth/earth.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kUniformSigmaRad = 1.81;  // of a heading that is anywhere: pi / sqrt(3)
constexpr double kScoredLastS = 20.0;

/// Begins a trial with a heading that is off by so much, and said to be anywhere.
void start_with_heading_off(RecordedTrial& trial, double off_rad) {
  const Eigen::Vector3d down_e = down_e_at(trial.start.estimate.nav.r_e_m);
  ErrorVector turn = ErrorVector::Zero();
  turn.segment<3>(kPsi) = off_rad * down_e;
  inject(trial.start.estimate, turn);
  trial.start.P.block<3, 3>(kPsi, kPsi) +=
      kUniformSigmaRad * kUniformSigmaRad * down_e * down_e.transpose();
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
  const Scene scene = drive_scene(
      car_drive({.initial_rest_s = 2.0, .duration_s = 120.0}), 25.0,
      {.tilt_rad = 0.03, .heading_rad = 1e-3, .velocity_mps = 0.1, .position_m = 2.5});
  const auto trials = recorded_trials(scene, options.brief ? 2 : 5);
  return cells_over(std::vector{0.0, 30.0, 90.0, 135.0, 180.0}, [&](double off_deg) {
    std::vector<RecordedTrial> off = trials;
    for (RecordedTrial& trial : off) start_with_heading_off(trial, off_deg * kRadPerDeg);
    return scored(few_atlas_columns(), scene.filter, off,
                  std::to_string(std::lround(off_deg)) + " deg", late_heading_error_deg);
  });
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
