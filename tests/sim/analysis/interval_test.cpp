#include "leeway/sim/analysis/interval.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "leeway/earth/error.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/motion/trajectories.hpp"

namespace leeway::sim {
namespace {

/// reference/README.md, "Correction interval, a defined case".
Scene defined_case(ImuClass imu, bool drifting = false) {
  Scene scene;
  scene.name = "defined case";
  scene.trajectory = square_loop();
  scene.duration_s = 14400.0;
  ImuErrorModel model = imu_class_model(imu, RangeEnd::kMid);
  if (drifting) {
    model.accelerometer.in_run = {model.accelerometer.bias_sigma, 3600.0};
    model.gyro.in_run = {model.gyro.bias_sigma, 3600.0};
    model.accelerometer.bias_sigma = model.gyro.bias_sigma = 0.0;
  }
  set_imu(scene, std::string(name(imu)), model);
  scene.filter.gnss_correlation_s = 0.0;
  return scene;
}

}  // namespace

TEST_CASE("the defined case: the reference's intervals within 6 %" * doctest::test_suite("heavy")) {
  // They were interpolated on a coarse grid of intervals: hence the 6 %.
  struct Row {
    ImuClass imu;
    bool drifting;
    std::vector<double> interval_s;
  };
  for (const Row& row : {Row{ImuClass::kMarine, false, {5.9, 55, 280, 633, 1241}},
                         Row{ImuClass::kMarine, true, {5.8, 55, 280, 633, 1242}},
                         Row{ImuClass::kTactical, false, {3.7, 21, 59, 104, 180}},
                         Row{ImuClass::kTactical, true, {3.6, 18, 42, 75, 134}}}) {
    const auto answers =
        solve_intervals(defined_case(row.imu, row.drifting), {1.0, 3.0, 10.0, 30.0, 100.0});
    for (std::size_t i = 0; i < answers.size(); ++i) {
      CAPTURE(name(row.imu));
      CAPTURE(row.drifting);
      CAPTURE(answers[i].limit_m);
      CHECK(std::abs(answers[i].interval_s / row.interval_s[i] - 1.0) < 0.06);
      CHECK(answers[i].true_m <= answers[i].limit_m);
      CHECK(answers[i].step_effect < 0.005);
    }
  }
}

TEST_CASE("a longer interval than the answer breaks the limit") {
  const Scene scene = defined_case(ImuClass::kTactical);
  const Interval answer = solve_intervals(scene, {30.0}).front();
  Scene longer = scene;
  longer.gnss.interval_s = 1.01 * answer.interval_s;
  CHECK(analyze(longer, error_track(longer)).true_m > 30.0);
}

TEST_CASE("observers see the answer, and the limit passed without fixes") {
  Scene scene = defined_case(ImuClass::kTactical);
  scene.duration_s = 1200.0;
  std::map<double, double> true_m;
  double before_m = 0.0;
  double passed_s = 0.0;
  IntervalConfig config;
  config.observer = [&](double interval_s, const CovarianceAnalysis& analysis) {
    true_m[interval_s] = analysis.true_m;
  };
  config.free_inertial_observer = [&](double t_s, double error_m) {
    if (before_m < 30.0 && error_m >= 30.0) passed_s = t_s;
    before_m = error_m;
  };
  const Interval answer = solve_intervals(scene, {30.0}, config).front();
  REQUIRE(true_m.contains(answer.interval_s));
  CHECK(true_m[answer.interval_s] == answer.true_m);
  CHECK(true_m.size() > 3);
  CHECK(passed_s >= answer.free_inertial_s);
  CHECK(passed_s - answer.free_inertial_s < 1.01);  // a step
}

TEST_CASE("limits out of reach are said to be") {
  Scene scene = defined_case(ImuClass::kMarine);
  scene.duration_s = 1200.0;
  const auto answers = solve_intervals(scene, {0.01, 1e5});
  CHECK(answers[0].outcome == Interval::Outcome::kNever);
  CHECK(std::isnan(answers[0].interval_s));
  CHECK(answers[0].true_m > 0.01);  // what the shortest interval leaves
  CHECK(answers[1].outcome == Interval::Outcome::kAlways);
  CHECK(std::abs(answers[1].interval_s - 600.0) < 1e-6);
  CHECK(std::isnan(answers[1].free_inertial_s));
}

TEST_CASE("wrong configurations are refused with the allowed range") {
  const Scene scene = defined_case(ImuClass::kMarine);
  CHECK_THROWS_WITH_AS(solve_intervals(scene, {-1.0}), doctest::Contains("must be > 0"), Error);
  IntervalConfig config;
  config.shortest_s = 1e5;
  CHECK_THROWS_WITH_AS(solve_intervals(scene, {1.0}, config),
                       doctest::Contains("half the scene's duration"), Error);
}

}  // namespace leeway::sim
