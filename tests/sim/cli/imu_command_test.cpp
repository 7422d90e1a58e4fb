#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/sim/cli/program.hpp"
#include "tests/support/near.hpp"

namespace leeway::test {
namespace {

using nlohmann::json;

json results(const std::string& arguments) {
  const Outcome outcome = leeway("imu " + arguments + " --json");
  CAPTURE(outcome.err);
  REQUIRE(outcome.exit_code == 0);
  return outcome.json().at("results");
}

}  // namespace

TEST_CASE("imu: the catalogue as a table and as JSON") {
  const Outcome list = leeway("imu");
  CHECK(list.exit_code == 0);
  CHECK(contains(list.out, "STIM300"));
  CHECK(contains(list.out, "Honeywell"));
  const json parts = results("");
  CHECK(parts.size() >= 15);
  for (const json& part : parts) {
    CHECK(contains(list.out, part.at("name").get<std::string>()));
    CHECK(part.at("datasheet").get<std::string>().size() > 5);
  }
}

TEST_CASE("imu: a part with its datasheet, conversions, assumptions and class") {
  const Outcome part = leeway("imu stim-300");
  CHECK(part.exit_code == 0);
  CHECK(contains(part.out, "TS1524"));
  CHECK(contains(part.out, "5 deg/h = 5 / 3600 deg/s = 2.424e-05 rad/s"));
  CHECK(contains(part.out, "(assumed)"));
  CHECK(contains(part.out, "(Allan minimum)"));
  CHECK(contains(part.out, "tactical, the worst of"));
  const json stim = results("STIM300");
  const double noise = stim.at("model").at("gyro").at("noise_radps_per_sqrt_hz");
  // 0.15 deg/sqrt(h); printed with all digits, so a rounding or two.
  CHECK(near(noise, 0.15 / 60.0 * std::numbers::pi / 180.0, 1e-19));
  CHECK(stim.at("class").at("overall") == "tactical");
  CHECK(stim.at("values").size() == 13);
}

TEST_CASE("imu: classes and model files the same way") {
  const json high = results("tactical --range high");
  CHECK(high.at("class").at("overall") == "tactical");
  CHECK(high.at("model").at("accelerometer").at("bias_sigma_mps2") == 0.1);
  CHECK(results("automotive-mems").at("model").at("accelerometer").at("in_run_tau_s") == 300.0);
  const Outcome file = leeway("imu " + quoted(LEEWAY_MODELS_DIR "/tactical-complete.toml"));
  CHECK(file.exit_code == 0);
  CHECK(contains(file.out, "5 deg/h = 5 / 3600 deg/s"));
  CHECK(contains(file.out, "a known g-sensitivity"));
  CHECK(contains(file.out, "quantization"));
}

TEST_CASE("imu: what is unknown is refused with the closest") {
  const struct {
    const char* arguments;
    const char* named;
  } cases[] = {
      {"imu stim30", "unknown IMU 'stim30': did you mean 'STIM300'?"},
      {"imu nowhere.toml", "nowhere.toml: cannot be read"},
      {"imu tactical --range top", "--range"},
      {"simulate --trajectory car --out /nowhere --imu-part stim30", "did you mean 'STIM300'?"},
      {"simulate --trajectory car --out x --imu-part STIM300 --imu-class tactical", "--imu-part"},
      {"simulate --trajectory car --out x --imu-part STIM300 --range low", "--range"},
      {"simulate --trajectory car --out x --imu-part STIM300 --imu-model y", "--imu-model"},
  };
  for (const auto& c : cases) {
    CAPTURE(std::string(c.arguments));
    const Outcome outcome = leeway(c.arguments);
    CAPTURE(outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK(outcome.out.empty());
    CHECK(contains(outcome.err, c.named));
  }
}

TEST_CASE("imu: a part of the catalogue is simulated and fused, turn-on and in-run bias together") {
  const TempDir dir;
  const std::string out = quoted(dir / "drive");
  REQUIRE(leeway("simulate --trajectory car --duration-s 120 --imu-rate-hz 50 --imu-part adis16470 "
                 "--out " +
                 out)
              .exit_code == 0);
  const Outcome fused = leeway("fuse --imu " + quoted(dir / "drive/imu.csv") + " --gnss " +
                               quoted(dir / "drive/gnss.csv") + " --truth " +
                               quoted(dir / "drive/truth.csv") + " --imu-part ADIS16470 --json");
  CAPTURE(fused.err);
  REQUIRE(fused.exit_code == 0);
  // GNSS at 1 Hz that is off by 1.6 m: a filter that works stays within twice that.
  CHECK(fused.json().at("results").at("rms").at("horizontal_m") < 3.2);
}

}  // namespace leeway::test
