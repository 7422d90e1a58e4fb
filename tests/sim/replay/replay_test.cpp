#include "leeway/sim/replay/replay.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/gnss_simulator.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "tests/sim/replay/recorded_logs.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

/// The logs of a drive on the square loop with perfect sensors, or with those of a model.
ReplayInput record(const test::TempDir& dir, double duration_s, const ImuErrorModel& model = {},
                   const GnssErrorModel& gnss_model = {}) {
  SquareLoopParameters parameters;
  parameters.duration_s = duration_s;
  return record_logs(dir, square_loop(parameters), duration_s, model, gnss_model);
}

NavigatorConfig white_gnss(const ImuErrorModel& imu) {
  NavigatorConfig config;
  config.filter.imu = imu;
  config.filter.gnss_correlation_s = 0.0;
  return config;
}

Alignment start_of(const ReplayInput& input, const ImuErrorModel& imu, const InitialSigma& sigma) {
  TruthLogReader reader(input.truth);
  Alignment start;
  start.estimate.nav = nav_state_from_ned(reader.next()->nav);
  start.P = initial_covariance(start.estimate, sigma, imu);
  return start;
}

}  // namespace

TEST_CASE("an observer is told what the result counts") {
  const test::TempDir dir;
  const ImuErrorModel imu = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  ReplayInput input = record(dir, 120.0, imu);
  input.outages = {{80.0, 20.0}};
  double error_sq_m2 = 0.0;
  std::int64_t epochs = 0;
  std::int64_t fixes = 0;
  std::array<std::uint64_t, kVerdicts> verdicts{};
  std::vector<OutageEpoch> outage;
  ReplayObserver observer;
  observer.epoch = [&](const Solution& s, const std::optional<TruthRecord>& truth) {
    REQUIRE(truth);
    const Eigen::Vector3d error_n_m = ned_to_ecef(truth->nav.position).transpose() *
                                      (s.nav.r_e_m - ecef_from_geodetic(truth->nav.position));
    error_sq_m2 += error_n_m.head<2>().squaredNorm();
    ++epochs;
  };
  observer.fix = [&](const UpdateOutcome&) { ++fixes; };
  observer.verdict = [&](Time, Verdict v) { ++verdicts[static_cast<std::size_t>(v)]; };
  observer.outage = [&](const OutageEpoch& e) { outage.push_back(e); };
  const ReplayResult r = replay(input, white_gnss(imu), observer);

  CHECK(epochs == r.rms.epochs);
  const double rms_m = std::sqrt(error_sq_m2 / static_cast<double>(epochs));
  CHECK(test::near(rms_m, r.rms.horizontal_m, 1e-9));
  CHECK(fixes == r.fixes);
  CHECK(verdicts[static_cast<std::size_t>(Verdict::kFused)] ==
        r.verdicts[static_cast<std::size_t>(Verdict::kFused)]);
  CHECK(verdicts[static_cast<std::size_t>(Verdict::kAccepted)] == 0);
  REQUIRE(outage.size() == 20);  // a withheld fix each second
  CHECK(outage.back().since_s == 20.0);
  CHECK(outage.back().error_h_m == r.outages[0].end_error_h_m);
  CHECK(outage.back().sigma_h_m == r.outages[0].end_sigma_h_m);
}

TEST_CASE("perfect sensors from a perfect start: an outage costs next to nothing") {
  const test::TempDir dir;
  GnssErrorModel receiver;
  receiver.position_sigma_n_m.setConstant(1e-3);
  receiver.velocity_sigma_n_mps.setConstant(1e-3);
  ReplayInput input = record(dir, 200.0, {}, receiver);
  const ImuErrorModel imu = imu_class_model(ImuClass::kMarine, RangeEnd::kMid);
  input.start = start_of(input, imu, {1e-6, 1e-6, 1e-3, 1e-3});
  input.outages = {{100.0, 60.0}, {120.0, 30.0}, {190.0, 60.0}};
  const ReplayResult r = replay(input, white_gnss(imu));

  REQUIRE(r.outages.size() == 3);
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(r.outages[i].against == Against::kReference);
    // The 1 mm/s of the fixes leave about 0.1 mm/s in the velocity: 6 mm in 60 s. Twenty times that
    // is still far below what any mistake in time or frame makes at 20 m/s.
    CHECK(r.outages[i].end_error_h_m < 0.1);
    CHECK(r.outages[i].max_error_h_m >= r.outages[i].end_error_h_m);
  }
  CHECK(r.outages[2].against == Against::kNothing);  // the log ends before the outage does
  CHECK(r.rms.horizontal_m < 0.01);
  CHECK(r.rms.attitude_deg < 0.01);
  CHECK(r.rms.epochs > 1900);
}

TEST_CASE("each outage is withheld alone, branching from the fully aided state" *
          doctest::test_suite("heavy")) {
  const test::TempDir dir;
  const ImuErrorModel imu = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  ReplayInput input = record(dir, 240.0, imu);
  input.start = start_of(input, imu, {3e-3, 0.01, 0.05, 2.5});
  const std::vector<Outage> outages{{100.0, 30.0}, {110.0, 60.0}, {100.0, 60.0}};
  input.outages = outages;
  const ReplayResult together = replay(input, white_gnss(imu));
  for (std::size_t i = 0; i < outages.size(); ++i) {
    CAPTURE(i);
    input.outages = {outages[i]};
    const ReplayResult alone = replay(input, white_gnss(imu));
    CHECK(alone.outages[0].end_error_h_m == together.outages[i].end_error_h_m);
    CHECK(alone.rms.horizontal_m == together.rms.horizontal_m);
  }
  input.outages = {};
  CHECK(replay(input, white_gnss(imu)).nis_mean == together.nis_mean);
}

TEST_CASE("an outage's error equals that of a log in which the fixes are missing") {
  const test::TempDir dir;
  const ImuErrorModel imu = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  ReplayInput input = record(dir, 161.0, imu);
  input.start = start_of(input, imu, {3e-3, 0.01, 0.05, 2.5});
  input.outages = {{100.0, 60.0}};
  const double branch_m = replay(input, white_gnss(imu)).outages[0].end_error_h_m;

  GnssLogReader all(input.gnss);
  GnssLogWriter cut(dir / "cut.csv");
  while (const auto fix = all.next()) {
    if (to_seconds(fix->time) <= 100.0) cut.write(*fix);
  }
  cut.close();
  input.gnss = dir / "cut.csv";
  input.outages = {};
  input.solution = dir / "solution.csv";
  input.solution_rate_hz = kRecordedImuHz;
  replay(input, white_gnss(imu));
  // The solution's file is read back as a truth log, by its columns.
  TruthTrack solution{TruthLogReader(input.solution)};
  TruthTrack truth{TruthLogReader(input.truth)};
  const Time end = time_from_seconds(160.0);
  const Eigen::Vector3d a = ecef_from_geodetic(solution.interpolate(end)->nav.position);
  const NavStateNed b = truth.interpolate(end)->nav;
  const Eigen::Vector3d d_n =
      ned_to_ecef(b.position).transpose() * (a - ecef_from_geodetic(b.position));
  // The file rounds latitude and longitude to 11 um; the cut log rounds its fixes to 1e-8 m.
  CHECK(test::near(d_n.head<2>().norm(), branch_m, 1e-4));
}

TEST_CASE("without truth the withheld fixes are the measure") {
  const test::TempDir dir;
  const ImuErrorModel imu = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  ReplayInput input = record(dir, 200.0, imu);
  input.start = start_of(input, imu, {3e-3, 0.01, 0.05, 2.5});
  input.truth.clear();
  input.outages = {{100.0, 30.0}};
  const ReplayResult r = replay(input, white_gnss(imu));
  CHECK(r.outages[0].against == Against::kGnss);
  CHECK(r.outages[0].end_error_h_m > 0.0);
  // 30 s of tactical drift beside 2.5 m per axis of the fix: the reference's T = 30 s gives 4.15 m
  // DRMS settled; ten times that would be a mistake.
  CHECK(r.outages[0].end_error_h_m < 40.0);
  CHECK(r.rms.epochs == 0);
}

TEST_CASE("the window limits what truth is used") {
  const test::TempDir dir;
  const ImuErrorModel imu = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  ReplayInput input = record(dir, 100.0, imu);
  input.start = start_of(input, imu, {3e-3, 0.01, 0.05, 2.5});
  input.truth_from_s = 50.0;
  input.truth_to_s = 60.0;
  input.outages = {{20.0, 10.0}, {45.0, 10.0}};
  const ReplayResult r = replay(input, white_gnss(imu));
  CHECK(r.rms.epochs == 101);
  CHECK(r.outages[0].against == Against::kNothing);
  CHECK(r.outages[1].against == Against::kReference);
}

}  // namespace leeway::sim
