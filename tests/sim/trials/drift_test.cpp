#include "leeway/sim/trials/drift.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "leeway/earth/error.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

const DriftRow& find(const DriftStudy& study, ImuClass imu, RangeEnd range, DriftReading reading) {
  return *std::find_if(study.rows.begin(), study.rows.end(), [&](const DriftRow& row) {
    return row.imu == imu && row.range == range && row.reading == reading;
  });
}

}  // namespace

// One study at the program's settings serves all cases below: it takes seconds.
static const DriftStudy& study() {
  static const DriftStudy kStudy = drift_study({});
  return kStudy;
}

TEST_CASE("[seed Table 2] as printed stands beside the other readings" *
          doctest::test_suite("heavy")) {
  constexpr std::array kErrors{0.9, 3.1, 10.2, 87.3, 867.7};
  constexpr std::array kTimes{980.0, 580.0, 325.0, 110.0, 35.0};
  for (std::size_t i = 0; i < kAll<ImuClass>.size(); ++i) {
    const DriftRow& row = find(study(), kAll<ImuClass>[i], RangeEnd::kLow, DriftReading::kPaper);
    CHECK(row.error_100s_m == kErrors[i]);
    CHECK(row.time_to_100m_s == kTimes[i]);
  }
  CHECK(study().rows.size() == 5 * 5);
}

TEST_CASE("the paper's assumptions give 0.866 b t^2 within 1 %" * doctest::test_suite("heavy")) {
  // 0.5 sqrt(3) b t^2; at 100 s the Earth's gravity field changes it by under 0.3 %.
  constexpr std::array kLowDriftMps2{1e-4, 3e-4, 1e-3, 1e-2, 1e-1};
  for (std::size_t i = 0; i < kAll<ImuClass>.size(); ++i) {
    CAPTURE(i);
    const DriftRow& row =
        find(study(), kAll<ImuClass>[i], RangeEnd::kLow, DriftReading::kPaperAssumptions);
    const double expected_m = 0.5 * std::sqrt(3.0) * kLowDriftMps2[i] * 1e4;
    CHECK(test::near(row.error_100s_m, expected_m, 0.01 * expected_m));
    CHECK(row.error_100s_p2_5_m == row.error_100s_m);
  }
  // Without gravity's feedback it would take sqrt(100 m / 0.866 b): 107.46 s for tactical.
  const DriftRow& tactical =
      find(study(), ImuClass::kTactical, RangeEnd::kLow, DriftReading::kPaperAssumptions);
  CHECK(test::near(tactical.time_to_100m_s, 107.46, 0.5));
}

TEST_CASE("the complete model agrees with the independent reference within its Monte Carlo band" *
          doctest::test_suite("heavy")) {
  // The mean square of 200 trials of a 3-D error has 600 degrees of freedom at most and 200 at
  // least: its root scatters by 1 / sqrt(2 * 200) = 5 % at worst, 10 % for two sigma.
  struct Case {
    ImuClass imu;
    RangeEnd range;
    double error_100s_m;
  };
  for (const Case& c : {Case{ImuClass::kTactical, RangeEnd::kLow, 89.0},
                        Case{ImuClass::kTactical, RangeEnd::kMid, 275.0},
                        Case{ImuClass::kTactical, RangeEnd::kHigh, 868.0},
                        Case{ImuClass::kAutomotive, RangeEnd::kMid, 1444.0}}) {
    CAPTURE(c.error_100s_m);
    const DriftRow& row = find(study(), c.imu, c.range, DriftReading::kComplete);
    CHECK(test::near(row.error_100s_m, c.error_100s_m, 0.1 * c.error_100s_m));
    CHECK(row.error_100s_p2_5_m < row.error_100s_m);
    CHECK(row.error_100s_m < row.error_100s_p97_5_m);
  }
  // 100 m RMS after 106, 61 and 35 s; error grows as t^2, so its 10 % are 5 % of the time.
  constexpr std::array kTimes{106.0, 61.0, 35.0};
  for (std::size_t i = 0; i < kAll<RangeEnd>.size(); ++i) {
    const DriftRow& row =
        find(study(), ImuClass::kTactical, kAll<RangeEnd>[i], DriftReading::kComplete);
    CHECK(test::near(row.time_to_100m_s, kTimes[i], 0.05 * kTimes[i]));
  }
}

TEST_CASE("curves start at zero, one point a second, and end past 100 s and 100 m" *
          doctest::test_suite("heavy")) {
  REQUIRE(study().curves.size() == 5 * 4);
  for (const DriftCurve& curve : study().curves) {
    REQUIRE(curve.t_s.size() == curve.error_m.size());
    CHECK(curve.error_m.front() == 0.0);
    CHECK(curve.t_s[100] == 100.0);
    CHECK(curve.error_m.back() >= 100.0);
  }
}

TEST_CASE("the study is the same in every run" * doctest::test_suite("heavy")) {
  DriftConfig config;
  config.trials = 4;
  config.max_time_s = 101.0;
  const DriftStudy a = drift_study(config);
  const DriftStudy b = drift_study(config);
  for (std::size_t i = 0; i < a.rows.size(); ++i) {
    CHECK(a.rows[i].error_100s_m == b.rows[i].error_100s_m);
  }
  config.seed = 2;
  CHECK(drift_study(config).rows[2].error_100s_m != a.rows[2].error_100s_m);
}

TEST_CASE("a configuration out of range is refused by name") {
  DriftConfig config;
  config.trials = 1;
  CHECK_THROWS_WITH_AS(drift_study(config), doctest::Contains("trials"), Error);
  config = {};
  config.latitude_deg = 91.0;
  CHECK_THROWS_WITH_AS(drift_study(config), doctest::Contains("latitude_deg"), Error);
  config = {};
  config.imu_rate_hz = 0.0;
  CHECK_THROWS_WITH_AS(drift_study(config), doctest::Contains("imu_rate_hz"), Error);
  config = {};
  config.max_time_s = 50.0;
  CHECK_THROWS_WITH_AS(drift_study(config), doctest::Contains("max_time_s"), Error);
}

}  // namespace leeway::sim
