#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <string>

#include "tests/sim/cli/program.hpp"

namespace leeway::test {
namespace {

std::string scene() {
  return quoted(std::filesystem::path(LEEWAY_SCENES_DIR) / "square-loop.toml");
}

/// Two minutes of the defined case, fixes every 10 s.
std::string reduce_model(const std::string& options) {
  return "reduce --scene " + scene() + " --interval-s 10 --at 120 --trials 3 --repeat 1 " + options;
}

}  // namespace

TEST_CASE("reduce --json --write: the contract, and a filter that campaign takes") {
  const TempDir dir;
  const auto object = leeway(reduce_model("--json --write " + quoted(dir / "f.toml"))).json();
  CHECK(object.at("command") == "reduce");
  CHECK(object.at("input").at("trials") == 3);
  const auto& results = object.at("results");
  CHECK(results.at("limit_m") == 10.0);
  std::set<std::string> names;
  for (const auto& term : results.at("terms")) {
    CAPTURE(term.dump());
    CHECK(names.insert(term.at("term").get<std::string>()).second);
    CHECK(term.at("kept").is_boolean());
    CHECK(term.at("cost_ns_per_s").is_number());
    if (term.at("term") != "double_precision") CHECK(term.at("predicted_m") >= 0.0);
  }
  for (const char* name : {"earth_rotation", "coriolis", "coning", "sculling", "imu_rate_fifth"}) {
    CHECK(names.count(name) == 1);
  }
  for (const char* model : {"full", "full_covariance_0_1_s", "reduced_full_rate", "reduced"}) {
    CAPTURE(model);
    CHECK(results.at(model).at("cost_ns_per_s") > 0.0);
    CHECK(results.at(model).at("measured_m") > 0.0);
    CHECK(results.at(model).at("rms_over_sigma") > 0.0);
  }
  CHECK(results.at("keeps_limit") == true);

  CHECK(contains(read_file(dir / "f.toml"), "[filter]"));
  const auto campaign =
      leeway("campaign --scene " + scene() +
             " --interval-s 10 --at 120 --trials 3 --json --filter " + quoted(dir / "f.toml"));
  CHECK(campaign.exit_code == 0);
  const double rms_m = campaign.json().at("results").at("rms_horizontal_m");
  const double in_reduce_m = results.at("reduced").at("rms_horizontal_m");
  CHECK(std::abs(rms_m - in_reduce_m) < 1e-3);  // Ekf against BasicEkf: rounding
}

TEST_CASE("reduce prints every term with both figures and its cost, then the models") {
  const Outcome outcome = leeway(reduce_model(""));
  CHECK(outcome.exit_code == 0);
  CHECK(outcome.err.empty());
  for (const char* text : {"square loop", "limit 10 m (drms)", "3 trials, seeds 1 to 3",
                           "predicted, m", "measured, m", "ratio", "cost, ns/s", "earth_rotation",
                           "reduced, full IMU rate", "RMS/sigma", "NEES", "keeps the limit"}) {
    CAPTURE(text);
    CHECK(contains(outcome.out, text));
  }
}

TEST_CASE("a limit that no model keeps is no answer, and writes nothing") {
  const TempDir dir;
  const Outcome outcome = leeway(reduce_model("--limit 0.01 --write " + quoted(dir / "f.toml")));
  CHECK(outcome.exit_code == 2);
  CHECK(contains(outcome.out, "misses the limit"));
  CHECK(!std::filesystem::exists(dir / "f.toml"));
}

TEST_CASE("reduce and --filter refuse what they cannot do, and say what to do") {
  for (const char* options : {"--trials 0", "--repeat 0", "--threads -1", "--write"}) {
    CAPTURE(options);
    const Outcome outcome = leeway(reduce_model(options));
    CHECK(outcome.exit_code == 1);
    CHECK(contains(outcome.err, "leeway: "));
    CHECK(outcome.out.empty());
  }
  const TempDir dir;
  std::ofstream(dir / "bad.toml") << "[filter]\nscheme = \"two_samples\"\n";
  const Outcome misspelt = leeway(reduce_model("--filter " + quoted(dir / "bad.toml")));
  CHECK(misspelt.exit_code == 1);
  CHECK(contains(misspelt.err, "bad.toml:2"));
  CHECK(contains(misspelt.err, "two-sample"));
  std::ofstream(dir / "none.toml") << "[scene]\n";
  CHECK(contains(leeway(reduce_model("--filter " + quoted(dir / "none.toml"))).err, "[filter]"));
  CHECK(leeway(reduce_model("--filter " + quoted(dir / "absent.toml"))).exit_code == 1);
}

}  // namespace leeway::test
