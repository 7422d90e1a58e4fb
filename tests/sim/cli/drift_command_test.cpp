#include <doctest/doctest.h>

#include <algorithm>
#include <stdexcept>

#include "tests/sim/cli/program.hpp"
#include "tests/sim/cli/simulated.hpp"
#include "tests/support/near.hpp"

namespace leeway::test {
namespace {

// 10 Hz is ample for a vehicle at rest: explicit Euler is off by 1 / 1000 of the error at 100 s.
constexpr const char* kDrift = "drift --trials 100 --imu-rate-hz 10 --seed 1 ";

const nlohmann::json& drift() {
  static const nlohmann::json result = leeway(std::string(kDrift) + "--json").json();
  return result;
}

const nlohmann::json& row(const char* imu, const char* range, const char* reading) {
  for (const auto& r : drift().at("results")) {
    if (r.at("imu") == imu && r.at("range") == range && r.at("reading") == reading) return r;
  }
  throw std::runtime_error(std::string("no row ") + imu + " " + range + " " + reading);
}

TEST_CASE("drift --json: the contract" * doctest::test_suite("heavy")) {
  CHECK(drift().at("leeway").is_string());
  CHECK(drift().at("command") == "drift");
  CHECK(drift().at("input").at("trials") == 100);
  CHECK(drift().at("input").at("seed") == 1);
  // Five classes: the paper, its assumptions, and the complete model at three points of the range.
  REQUIRE(drift().at("results").size() == 25);
  for (const auto& r : drift().at("results")) {
    for (const char* key :
         {"error_100s_m", "error_100s_p2_5_m", "error_100s_p97_5_m", "time_to_100m_s"}) {
      CAPTURE(key);
      CHECK(r.at(key).is_number());
    }
    CHECK(r.at("error_100s_p2_5_m") <= r.at("error_100s_m"));
    CHECK(r.at("error_100s_m") <= r.at("error_100s_p97_5_m"));
  }
}

TEST_CASE("drift: the paper's cells as printed, its assumptions within 1 %" *
          doctest::test_suite("heavy")) {
  const struct {
    const char* imu;
    double paper_m;
    double assumptions_m;
    double paper_s;
  } cases[] = {{"marine", 0.9, 0.866, 980.0},
               {"aviation", 3.1, 2.60, 580.0},
               {"intermediate", 10.2, 8.66, 325.0},
               {"tactical", 87.3, 86.6, 110.0},
               {"automotive", 867.7, 866.0, 35.0}};
  for (const auto& c : cases) {
    CAPTURE(c.imu);
    CHECK(row(c.imu, "low", "paper").at("error_100s_m") == c.paper_m);
    CHECK(row(c.imu, "low", "paper").at("time_to_100m_s") == c.paper_s);
    const double m = row(c.imu, "low", "paper_assumptions").at("error_100s_m");
    CHECK(near(m / c.assumptions_m, 1.0, 0.01));
  }
}

TEST_CASE("drift: the complete model within the Monte Carlo band of the reference") {
  // The squared norm of three equal normals has a relative deviation of sqrt(2 / 3); the RMS of 100
  // has 4.1 %. Three and a half of them.
  constexpr double kBand = 0.145;
  const struct {
    const char* imu;
    const char* range;
    double error_m;
  } cases[] = {{"tactical", "low", 89.0},
               {"tactical", "mid", 275.0},
               {"tactical", "high", 868.0},
               {"automotive", "mid", 1444.0}};
  for (const auto& c : cases) {
    CAPTURE(c.imu);
    CAPTURE(c.range);
    const double m = row(c.imu, c.range, "complete").at("error_100s_m");
    CHECK(near(m / c.error_m, 1.0, kBand));
  }
  // Errors grow with t^2, so times have half that band.
  CHECK(near(row("tactical", "low", "complete").at("time_to_100m_s").get<double>() / 106.0, 1.0,
             0.5 * kBand));
  CHECK(near(row("tactical", "mid", "complete").at("time_to_100m_s").get<double>() / 61.0, 1.0,
             0.5 * kBand));
}

TEST_CASE("drift prints the table, says why the readings differ, and writes the curves" *
          doctest::test_suite("heavy")) {
  const TempDir dir;
  const Outcome outcome = leeway(std::string(kDrift) + "--curves " + quoted(dir / "curves.csv"));
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  for (const char* text : {"marine", "automotive", "paper", "its assumptions", "complete",
                           "gyro drift\nleft out", "0.866 b t^2", "curves.csv"}) {
    CAPTURE(text);
    CHECK(contains(outcome.out, text));
  }
  const std::vector<std::string> lines = lines_of(dir / "curves.csv");
  REQUIRE(lines.size() > 102);
  const std::string& header = lines[0];
  CHECK(header.starts_with("t_s,marine_low_paper_assumptions_m,"));
  for (const char* column : {"tactical_mid_complete_m", "tactical_mid_complete_p2_5_m",
                             "automotive_high_complete_p97_5_m"}) {
    CAPTURE(column);
    CHECK(contains(header, column));
  }
  const auto commas = [](const std::string& s) { return std::count(s.begin(), s.end(), ','); };
  // A column for each assumptions curve, three for each complete one.
  CHECK(commas(header) == 5 * (1 + 3 * 3));
  for (const std::string& line : lines) REQUIRE(commas(line) == commas(header));
  // All curves reach 100 s; the first is the one of the table, six digits kept.
  const std::vector<double> at_100s = numbers_of(lines[101]);
  CHECK(at_100s[0] == 100.0);
  CHECK(near(at_100s[1], row("marine", "low", "paper_assumptions").at("error_100s_m"), 1e-5));
}

}  // namespace
}  // namespace leeway::test
