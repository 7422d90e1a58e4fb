#include <doctest/doctest.h>

#include <set>
#include <string>

#include "tests/sim/cli/program.hpp"

namespace leeway::test {
namespace {

/// Two minutes of the defined case, fixes every 10 s.
std::string compare(const std::string& options) {
  return "compare --scene " +
         quoted(std::filesystem::path(LEEWAY_SCENES_DIR) / "square-loop.toml") +
         " --interval-s 10 --at 120 --trials 2 --repeat 2 " + options;
}

}  // namespace

TEST_CASE("compare --json: the contract" * doctest::test_suite("heavy")) {
  const auto object = leeway(compare("--first-seed 3 --json")).json();
  CHECK(object.at("command") == "compare");
  CHECK(object.at("input").at("trials") == 2);
  CHECK(object.at("input").at("first_seed") == 3);
  CHECK(object.at("input").at("repeat") == 2);
  CHECK(object.at("input").at("duration_s") == 120.0);
  const auto& results = object.at("results");
  REQUIRE(results.size() > 150);
  std::set<std::string> names;
  for (const auto& row : results) names.insert(row.at("variant").get<std::string>());
  CHECK(names.size() == results.size());
  CHECK(names.count("two-sample/normal/turning/50Hz symmetric/joseph/double/0.1s") == 1);
  int on_front = 0;
  for (const auto& row : results) {
    CAPTURE(row.dump());
    CHECK(row.at("cost_least_ns_per_s") <= row.at("cost_ns_per_s"));
    CHECK(row.at("cost_ns_per_s") <= row.at("cost_most_ns_per_s"));
    // Float may end where it has no numbers, and then says so. Figures are of the other trials.
    const int lost = row.at("trials_not_finite");
    CHECK((lost > 0) == (row.at("consistency") == "not finite"));
    if (lost > 0) CHECK(contains(row.at("variant").get<std::string>(), "/float/"));
    const bool has_figures = lost < object.at("input").at("trials").get<int>();
    CHECK(row.at("rms_horizontal_m").is_null() != has_figures);
    if (has_figures) CHECK(row.at("rms_horizontal_m") > 0.0);
    CHECK(row.at("nees_band").size() == 2);
    const bool is_reset = row.at("consistency") == "no claim";
    CHECK(row.at("nees").is_null() == (is_reset || !has_figures));
    if (row.at("front") == true) {
      ++on_front;
      CHECK(row.at("dominated_by").is_null());
    } else if (!row.at("dominated_by").is_null()) {
      CHECK(names.count(row.at("dominated_by").get<std::string>()) == 1);
    }
  }
  CHECK(on_front >= 1);
}

TEST_CASE("compare prints the front, then everything, and under what conditions" *
          doctest::test_suite("heavy")) {
  const Outcome outcome = leeway(compare(""));
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  for (const char* text :
       {"square loop", "the first 120 s", "50, 25, 10 Hz", "2 trials, seeds 1 to 2", "2 runs",
        "The front", "dominated by", "RMS, m", "R95, m", "NEES", "ns/s", "reset", "no claim"}) {
    CAPTURE(text);
    CHECK(contains(outcome.out, text));
  }
}

TEST_CASE("compare refuses what it cannot do, and says what to do") {
  for (const char* options :
       {"--trials 0", "--repeat 0", "--repeat 1001", "--threads -1", "--first-seed -3", "--at 0"}) {
    CAPTURE(options);
    const Outcome outcome = leeway(compare(options));
    CHECK(outcome.exit_code == 1);
    CHECK(contains(outcome.err, "leeway: "));
    CHECK(outcome.out.empty());
  }
  CHECK(contains(leeway("compare").err, "--scene is required"));
  CHECK(contains(leeway(compare("--csv v.csv")).err, "--csv: gone: use --json"));
  const Outcome several = leeway(compare("--imu marine,tactical"));
  CHECK(several.exit_code == 1);
  CHECK(contains(several.err, "one IMU"));
  const Outcome too_short = leeway(
      "compare --scene " + quoted(std::filesystem::path(LEEWAY_SCENES_DIR) / "square-loop.toml") +
      " --interval-s 100 --at 120");
  CHECK(too_short.exit_code == 1);
  CHECK(contains(too_short.err, "two GNSS intervals"));
}

}  // namespace leeway::test
