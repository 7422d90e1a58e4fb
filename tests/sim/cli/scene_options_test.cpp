#include <doctest/doctest.h>

#include <string>

#include "tests/sim/cli/program.hpp"
#include "tests/sim/cli/simulated.hpp"
#include "tests/support/near.hpp"

namespace leeway::test {
namespace {

const std::filesystem::path kScenes = LEEWAY_SCENES_DIR;

std::string ready(const char* file) { return " --scene " + quoted(kScenes / file); }

/// What a command says of its scene. Two minutes at rest are enough for that.
nlohmann::json input_of(const std::string& options) {
  const Outcome outcome =
      leeway("analyze --json --at 120" + ready("static-45.toml") + " " + options);
  CAPTURE(options);
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return outcome.json().at("input");
}

std::string refusal(const std::string& options) {
  const Outcome outcome = leeway("analyze" + options);
  CHECK(outcome.exit_code == 1);
  CHECK(outcome.out.empty());
  return outcome.err;
}

TEST_CASE("a scene is taken as it is written") {
  const auto input = input_of("");
  CHECK(input.at("scene") == "static 45");
  CHECK(input.at("motion") == "static");
  CHECK(input.at("duration_s") == 120.0);
  CHECK(input.at("imu_model") == "tactical/mid");
  CHECK(input.at("bias_model") == "constant");
  CHECK(input.at("metric") == "drms");
  CHECK(input.at("limit_m") == 10.0);
  CHECK(input.at("gnss").at("interval_s") == 1.0);
  CHECK(input.at("gnss").at("position_sigma_ned_m") == nlohmann::json{2.5, 2.5, 3.5});
}

TEST_CASE("the command line changes IMU, bias, metric, limit and interval of a scene") {
  const auto input = input_of(
      "--imu marine --range high --bias gauss_markov --metric r95 --limit 30 --interval-s 10");
  CHECK(input.at("imu_model") == "marine/high");
  CHECK(input.at("bias_model") == "gauss_markov");
  CHECK(input.at("metric") == "r95");
  CHECK(input.at("limit_m") == 30.0);
  CHECK(input.at("gnss").at("interval_s") == 10.0);
  CHECK(input_of("--imu marine").at("imu_model") == "marine/mid");
  CHECK(input_of("--imu automotive-mems").at("imu_model") == "automotive-mems");
  CHECK(input_of("--imu stim300").at("imu_model") == "STIM300");
  CHECK(input_of("--bias gauss_markov").at("bias_model") == "gauss_markov");
}

TEST_CASE("what does not fit a scene is refused by its option") {
  const std::string at_rest = ready("static-45.toml") + " --at 120 ";
  CHECK(contains(refusal(""), "--scene"));
  CHECK(contains(refusal(" --scene none.toml"), "none.toml"));
  CHECK(contains(refusal(at_rest + "--imu tacticl"), "--imu tacticl: no class"));
  CHECK(contains(refusal(at_rest + "--imu marine,tactical"), "takes one IMU, not 2"));
  CHECK(contains(refusal(at_rest + "--range high"), "name it with --imu"));
  CHECK(contains(refusal(at_rest + "--imu marine --range higher"), "--range"));
  CHECK(contains(refusal(at_rest + "--imu STIM300 --bias constant"), "of its own"));
  CHECK(contains(refusal(at_rest + "--metric cep"), "--metric"));
  CHECK(contains(refusal(at_rest + "--limit -3"), "--limit"));
  CHECK(contains(refusal(at_rest + "--at 0.1"), "--at"));
  // A route has an end.
  CHECK(contains(refusal(ready("tunnel.toml") + " --at 5000"), "tunnel.toml:"));
}

TEST_CASE("simulate turns a scene into logs: outages left out, latency told") {
  const TempDir dir;
  const auto file = dir.file("scene.toml", R"(
[scene]
duration_s = 60
imu_rate_hz = 20
[trajectory]
type = "static"
[imu]
class = "marine"
[gnss]
latency_s = 0.25
outages = [{start_s = 10, duration_s = 20}]
)");
  const Outcome outcome =
      leeway("simulate --scene " + quoted(file) + " --seed 4 --out " + quoted(dir / "made"));
  CHECK(outcome.exit_code == 0);
  CHECK(contains(outcome.out, "0.25 s later"));
  CHECK(lines_of(dir / "made/imu.csv").size() == 1 + 1200);
  CHECK(lines_of(dir / "made/truth.csv").size() == 1 + 1201);
  const auto fixes = lines_of(dir / "made/gnss.csv");
  REQUIRE(fixes.size() == 1 + 40);  // 11 to 30 s are missing
  CHECK(numbers_of(fixes[10])[0] == 10.0);
  CHECK(numbers_of(fixes[11])[0] == 31.0);
  const auto made = nlohmann::json::parse(read_file(dir / "made/scene.json"));
  CHECK(made.at("gnss").at("latency_s") == 0.25);
  CHECK(made.at("seed") == 4);
}

TEST_CASE("simulate: outliers come as often and as large as the scene says") {
  const TempDir dir;
  const auto file = dir.file("scene.toml", R"(
[scene]
duration_s = 2000
imu_rate_hz = 1
[trajectory]
type = "static"
[imu]
class = "marine"
[gnss]
outlier_probability = 0.1
outlier_sigma_m = 1000
)");
  leeway("simulate --scene " + quoted(file) + " --out " + quoted(dir / "made"));
  const auto lines = lines_of(dir / "made/gnss.csv");
  const std::vector<double> truth = numbers_of(lines_of(dir / "made/truth.csv")[1]);
  int outliers = 0;
  double square_m2 = 0.0;
  for (std::size_t k = 1; k < lines.size(); ++k) {
    const double down_m = truth[3] - numbers_of(lines[k])[3];
    if (std::abs(down_m) < 20.0) continue;  // 6 sigma of the receiver
    ++outliers;
    square_m2 += down_m * down_m;
  }
  // 200 of 2000, 13.4 standard deviation; 2 % of them are small along down.
  CHECK(near(outliers, 196.0, 54.0));
  CHECK(near(std::sqrt(square_m2 / outliers), 1000.0, 4.0 * 1000.0 / std::sqrt(2.0 * outliers)));
}

TEST_CASE("simulate wants either a scene or a trajectory") {
  const TempDir dir;
  const std::string out = " --out " + quoted(dir / "x");
  CHECK(contains(leeway("simulate" + out).err, "--scene FILE.toml or --trajectory NAME"));
  const Outcome both = leeway("simulate --trajectory car" + ready("tunnel.toml") + out);
  CHECK(both.exit_code == 1);
  CHECK(contains(both.err, "excludes"));
}

}  // namespace
}  // namespace leeway::test
