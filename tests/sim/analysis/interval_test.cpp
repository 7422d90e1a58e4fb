#include "leeway/sim/analysis/interval.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/model/error_metric.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/analysis/coast.hpp"
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

TEST_CASE("an answer does not depend on what else is asked") {
  Scene scene = defined_case(ImuClass::kTactical);
  scene.duration_s = 2400.0;
  const std::vector<AllowedError> all{1.0, 10.0, {5.0, 0.05}, 30.0, {10.0, 0.01}};
  const auto together = solve_intervals(scene, all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    CAPTURE(text_of(all[i]));
    const Interval alone = solve_intervals(scene, {all[i]}).front();
    CHECK(alone.interval_s == together[i].interval_s);
    CHECK(alone.true_m == together[i].true_m);
    CHECK(alone.claimed_m == together[i].claimed_m);
    CHECK(alone.free_inertial_s == together[i].free_inertial_s);
  }
}

TEST_CASE("a first guess leads to the same answer, whether it keeps the limit or breaks it") {
  Scene scene = defined_case(ImuClass::kTactical);
  scene.duration_s = 2400.0;
  const double plain_s = solve_intervals(scene, {30.0}).front().interval_s;
  IntervalConfig config;
  config.first_guess_s = 0.7 * plain_s;
  // Each is within the tolerance of where the error meets the limit.
  const double guessed_s = solve_intervals(scene, {30.0}, config).front().interval_s;
  CHECK(std::abs(guessed_s / plain_s - 1.0) < 2.0 * config.tolerance);
  config.first_guess_s = 3.0 * plain_s;
  CHECK(solve_intervals(scene, {30.0}, config).front().interval_s == plain_s);
}

TEST_CASE("a limit that grows with the way: kept at the answer, broken beyond it") {
  Scene scene = defined_case(ImuClass::kTactical);
  scene.duration_s = 2400.0;
  // 20 m/s: a tenth of a metre is allowed for each second.
  const AllowedError allowed(5.0, 0.005);
  const auto answers = solve_intervals(scene, {allowed, 5.0});
  const Interval& growing = answers.front();
  REQUIRE(growing.outcome == Interval::Outcome::kSolved);
  CHECK(growing.share == 0.005);
  CHECK(growing.interval_s > 1.05 * answers.back().interval_s);
  // The way between fixes, but for that of a late start.
  CHECK(std::abs(growing.allowed_m - (5.0 + 0.1 * growing.interval_s)) < 0.05);
  CHECK(growing.true_m <= growing.allowed_m);
  CHECK(growing.true_m > 0.99 * growing.allowed_m);
  scene.limit.allow(allowed);
  for (const double factor : {1.0, 1.02}) {
    scene.gnss.interval_s = factor * growing.interval_s;
    const CovarianceAnalysis analysis = analyze(scene, error_track(scene));
    CHECK((analysis.true_m <= analysis.allowed_m) == (factor == 1.0));
    CHECK(analysis.true_m == analysis.true_errors.worst(allowed).error_m);
  }
  // Without fixes the way is that from the start.
  const ErrorTrack track = error_track(scene);
  double before_s = 0.0;
  bool is_passed = false;
  free_inertial(scene, track, [&](const CovariancePoint& p) {
    const double error_m = error_by_metric_m(
        scene, track, p.t_s, ned_covariance(p.r_e_m, p.truth.block<3, 3>(kDr, kDr)));
    is_passed = error_m >= allowed.after_m(20.0 * p.t_s);
    if (!is_passed) before_s = p.t_s;
    return !is_passed;
  });
  CHECK(is_passed);
  CHECK(growing.free_inertial_s >= before_s);
  CHECK(growing.free_inertial_s - before_s < 1.01);  // a step
}

TEST_CASE("coast time: what grows with the way allows more, from the fix before the outage on") {
  Scene scene = defined_case(ImuClass::kTactical);
  scene.duration_s = 900.0;
  scene.gnss.outages = {{600.0, 59.5}};
  const ErrorTrack track = error_track(scene);
  const Coast fixed = coasts(scene, track, 5.0).front();
  const Coast growing = coasts(scene, track, {5.0, 0.005}).front();
  CHECK(fixed.end_error_m == growing.end_error_m);
  CHECK(fixed.end_allowed_m == 5.0);
  // At 20 m/s, from the fix at 600 s to that at 660 s.
  CHECK(std::abs(growing.end_allowed_m - (5.0 + 0.005 * 1200.0)) < 0.01);
  CHECK(growing.coast_s > 1.05 * fixed.coast_s);
}

TEST_CASE("every metric has its answer, with and without fixes; 3D asks for more than horizontal") {
  Scene scene = defined_case(ImuClass::kTactical);
  scene.duration_s = 1200.0;
  std::map<ErrorMetric, Interval> answers;
  for (const ErrorMetric metric : kAll<ErrorMetric>) {
    CAPTURE(name(metric));
    scene.limit.metric = metric;
    const Interval& answer = answers[metric] = solve_intervals(scene, {20.0}).front();
    CHECK(answer.outcome == Interval::Outcome::kSolved);
    CHECK(answer.true_m <= 20.0);
    CHECK(answer.free_inertial_s > 1.0);
  }
  const auto order = [&](ErrorMetric longer, ErrorMetric shorter) {
    CHECK(answers[longer].interval_s > answers[shorter].interval_s);
    CHECK(answers[longer].free_inertial_s > answers[shorter].free_inertial_s);
  };
  order(ErrorMetric::kR50, ErrorMetric::kR68);
  order(ErrorMetric::kR68, ErrorMetric::kR95);
  order(ErrorMetric::kR95, ErrorMetric::kR99);
  order(ErrorMetric::kAxis, ErrorMetric::kDrms);
  order(ErrorMetric::kDrms, ErrorMetric::k3d);
  order(ErrorMetric::kCross95, ErrorMetric::kR95);
  order(ErrorMetric::kAlong95, ErrorMetric::kR95);
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
                       doctest::Contains("the longest that the scene can be asked for"), Error);
}

}  // namespace leeway::sim
