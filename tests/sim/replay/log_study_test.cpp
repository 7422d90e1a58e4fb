#include "leeway/sim/replay/log_study.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "leeway/earth/error.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/replay/study_answer.hpp"
#include "tests/sim/replay/recorded_logs.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

GnssErrorModel good_receiver() {
  GnssErrorModel model;
  model.position_sigma_n_m.setConstant(0.5);
  model.velocity_sigma_n_mps.setConstant(0.05);
  return model;
}

NavigatorConfig config_of(const ImuErrorModel& imu, VehicleKind kind = VehicleKind::kNone) {
  NavigatorConfig config;
  config.filter.imu = imu;
  config.filter.gnss_correlation_s = 0.0;
  config.vehicle = VehicleConfig::of(kind);
  return config;
}

ImuErrorModel automotive() { return automotive_mems_model(); }

/// The speed of the truth at a time of the log.
double true_speed_mps(const Trajectory& trajectory, double t_s) {
  return truth_at(trajectory, t_s).nav.v_e_mps.norm();
}

}  // namespace

TEST_CASE("outages begin while the car moves, after the time to settle, so far apart") {
  const test::TempDir dir;
  const Trajectory trajectory = car_drive();
  const ReplayInput input = record_logs(dir, trajectory, 240.0, automotive(), good_receiver());
  LogStudyConfig study;
  study.durations_s = {5.0, 20.0};
  study.every_s = 4.0;
  study.settle_s = 60.0;
  study.most_phases = 1;
  const LogStudy s = study_log(input, config_of(automotive()), study);
  REQUIRE(s.has_solution);
  CHECK(s.against == Against::kReference);
  CHECK(test::near(s.settled_s, s.first_s + 60.0, 1e-6));
  CHECK(test::near(s.receiver.interval_s, 1.0, 1e-6));
  std::set<double> starts_s;
  for (const OutageError& outage : s.outages) {
    CHECK(outage.start_s >= s.settled_s);
    // The solution's speed decides, ten times a second: within 2.5 m/s^2 * 0.1 s and its error.
    CHECK(true_speed_mps(trajectory, outage.start_s) > study.min_speed_mps - 0.5);
    CHECK(outage.start_s + outage.duration_s <= 240.0);
    CHECK(outage.largest_h_m >= outage.end_h_m);
    starts_s.insert(outage.start_s);
  }
  CHECK(starts_s.size() > 15);
  for (auto next = std::next(starts_s.begin()); next != starts_s.end(); ++next) {
    CHECK(*next - *std::prev(next) >= study.every_s);
  }
  // The car stands somewhere after the settling: starts that every_s alone would give are missing.
  CHECK(static_cast<double>(starts_s.size()) < (235.0 - s.settled_s) / study.every_s);
}

TEST_CASE("a study is the same on one thread and on two, and comes back from its bytes") {
  const test::TempDir dir;
  const ReplayInput input = record_logs(dir, square_loop(), 120.0, automotive(), good_receiver());
  LogStudyConfig study;
  study.most_phases = 2;
  study.threads = 1;
  const std::string one = bytes_of(study_log(input, config_of(automotive()), study));
  study.threads = 2;
  const LogStudy two = study_log(input, config_of(automotive()), study);
  CHECK(!two.errors.empty());
  CHECK(two.expected.size() == two.errors.size());
  CHECK(bytes_of(two) == one);
  CHECK(bytes_of(log_study_of(one)) == one);
}

TEST_CASE("the prediction is that of the errors which are measured" *
          doctest::test_suite("heavy")) {
  const test::TempDir dir;
  ReplayInput input = record_logs(dir, square_loop(), 900.0, automotive(), good_receiver());
  LogStudyConfig study;
  study.metric = ErrorMetric::kDrms;
  study.most_phases = 4;
  for (const bool has_truth : {true, false}) {
    CAPTURE(has_truth);
    if (!has_truth) input.truth.clear();
    const LogStudy s = study_log(input, config_of(automotive()), study);
    CHECK(s.against == (has_truth ? Against::kReference : Against::kGnss));
    const LogStudy* all[] = {&s};
    const StudyAnswer answer = answer_of(all, study, {5.0});
    const SupportedInterval& five = answer.supported[0];
    REQUIRE(five.measured_outcome == SupportedInterval::Outcome::kFound);
    REQUIRE(five.expected_outcome == SupportedInterval::Outcome::kFound);
    CHECK(five.measured_s.low <= five.measured_s.value);
    CHECK(five.measured_s.value <= five.measured_s.high);
    // One drive has the turn-on errors of one IMU, a few sigmas at most; the interval grows with
    // the error's square root or less.
    CHECK(five.expected_over_measured() > 0.67);
    CHECK(five.expected_over_measured() < 1.5);
    for (const IntervalErrors& e : answer.intervals) {
      // Fixes of a second leave the receiver's own error, which needs no IMU: here they agree.
      if (e.interval_s > 1.0) continue;
      CHECK(test::near(e.expected_m / e.measured_m.value, 1.0, 0.2));
    }
  }
}

TEST_CASE("a study says what it cannot take") {
  const test::TempDir dir;
  ReplayInput input;
  input.imu = dir / "none.csv";
  input.gnss = dir / "none.csv";
  CHECK_THROWS_WITH_AS(
      study_log(input, config_of(automotive()), {}),
      doctest::Contains("none.csv: is no file, and a study reads a log several times"), Error);
  LogStudyConfig study;
  study.every_s = 0.0;
  CHECK_THROWS_WITH_AS(study_log(input, config_of(automotive()), study),
                       doctest::Contains("every_s"), Error);
}

}  // namespace leeway::sim
