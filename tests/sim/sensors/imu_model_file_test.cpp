#include "leeway/sim/sensors/imu_model_file.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

using test::contains;
using test::near;
using test::TempDir;

ImuErrorModel model_of(const std::string& text) {
  const TempDir dir;
  return read_imu_model(dir.file("model.toml", text));
}

std::string refusal(const std::string& text) {
  return test::message_of<Error>([&text] { model_of(text); });
}

/// The value that a key of one number sets, and what it should be in the unit of the model.
struct UnitCase {
  const char* text;
  double (*value)(const ImuErrorModel&);
  double wanted;
};

TEST_CASE("every unit, against its definition") {
  const auto a_bias = [](const ImuErrorModel& m) { return m.accelerometer.bias.x(); };
  const auto a_sigma = [](const ImuErrorModel& m) { return m.accelerometer.bias_sigma; };
  const auto a_noise = [](const ImuErrorModel& m) { return m.accelerometer.noise_density; };
  const auto a_range = [](const ImuErrorModel& m) { return m.accelerometer.range; };
  const auto g_bias = [](const ImuErrorModel& m) { return m.gyro.bias.z(); };
  const auto g_sigma = [](const ImuErrorModel& m) { return m.gyro.bias_sigma; };
  const auto g_noise = [](const ImuErrorModel& m) { return m.gyro.noise_density; };
  const auto g_quantum = [](const ImuErrorModel& m) { return m.gyro.quantum; };
  const UnitCase cases[] = {
      {"[accelerometer]\nbias_mps2 = [0.1, 0, 0]", a_bias, 0.1},
      {"[accelerometer]\nbias_mg = [2, 0, 0]", a_bias, 0.0196133},
      {"[accelerometer]\nbias_ug = [-50, 0, 0]", a_bias, -4.903325e-4},
      {"[accelerometer]\nbias_sigma_mps2 = 0.3", a_sigma, 0.3},
      {"[accelerometer]\nbias_sigma_mg = 1", a_sigma, 9.80665e-3},
      {"[accelerometer]\nbias_sigma_ug = 1", a_sigma, 9.80665e-6},
      {"[accelerometer]\nnoise_ug_per_sqrt_hz = 100", a_noise, 9.80665e-4},
      {"[accelerometer]\nnoise_mps_per_sqrt_h = 0.06", a_noise, 1e-3},
      {"[accelerometer]\nrange_g = 2", a_range, 19.6133},
      {"[accelerometer]\nrange_mps2 = 50", a_range, 50.0},
      {"[gyro]\nbias_deg_per_h = [0, 0, 3600]", g_bias, kRadPerDeg},
      {"[gyro]\nbias_deg_per_s = [0, 0, 0.5]", g_bias, 0.5 * kRadPerDeg},
      {"[gyro]\nbias_radps = [0, 0, -0.01]", g_bias, -0.01},
      {"[gyro]\nbias_sigma_deg_per_h = 36", g_sigma, 0.01 * kRadPerDeg},
      {"[gyro]\nbias_sigma_deg_per_s = 0.01", g_sigma, 0.01 * kRadPerDeg},
      {"[gyro]\nbias_sigma_radps = 5e-6", g_sigma, 5e-6},
      {"[gyro]\nnoise_deg_per_sqrt_h = 60", g_noise, kRadPerDeg},
      {"[gyro]\nnoise_dps_per_sqrt_hz = 0.005", g_noise, 0.005 * kRadPerDeg},
      {"[gyro]\nquantum_arcsec = 3600", g_quantum, kRadPerDeg},
      {"[gyro]\nquantum_rad = 1e-6", g_quantum, 1e-6},
  };
  for (const UnitCase& c : cases) {
    CAPTURE(c.text);
    // Rounding of two or three products.
    CHECK(near(c.value(model_of(c.text)), c.wanted, 1e-15 * std::abs(c.wanted)));
  }
}

TEST_CASE("matrices") {
  const ImuErrorModel m = model_of(R"(
[accelerometer]
scale_ppm = [100, -200, 300]
misalignment_mrad = [1, 2, 3, 4, 5, 6]
quantum_mps = 1e-5
in_run_sigma_ug = 10
in_run_tau_s = 600
[gyro]
scale_ppm = 50
misalignment_mrad = [[0, 1, 2], [3, 0, 4], [5, 6, 0]]
range_deg_per_s = 250
g_sensitivity_deg_per_h_per_g = [[1, 0, 0], [0, 0, 2], [0, 0, 0]]
)");
  Eigen::Matrix3d M_a;
  M_a << 1.0001, 1e-3, 2e-3, 3e-3, 0.9998, 4e-3, 5e-3, 6e-3, 1.0003;
  CHECK(near(m.accelerometer.M, M_a, 1e-15));
  Eigen::Matrix3d M_g = M_a;
  M_g.diagonal().setConstant(1.00005);
  CHECK(near(m.gyro.M, M_g, 1e-15));
  const double one = kRadPerDeg / 3600.0 / 9.80665;
  CHECK(near(m.G_g_radps_per_mps2(0, 0), one, 1e-15 * one));
  CHECK(near(m.G_g_radps_per_mps2(1, 2), 2.0 * one, 1e-15 * one));
  CHECK(m.G_g_radps_per_mps2(2, 1) == 0.0);
  CHECK(m.accelerometer.quantum == 1e-5);
  CHECK(near(m.accelerometer.in_run.sigma, 9.80665e-5, 1e-19));
  CHECK(m.accelerometer.in_run.tau_s == 600.0);
  CHECK(near(m.gyro.range, 250.0 * kRadPerDeg, 1e-15));
}

TEST_CASE("what is absent is no error") {
  const ImuErrorModel m = model_of("[gyro]\nbias_sigma_radps = 0\n");
  CHECK(m.accelerometer.bias_sigma == 0.0);
  CHECK(m.accelerometer.M == Eigen::Matrix3d::Identity());
  CHECK(std::isinf(m.gyro.range));
  CHECK(m.G_g_radps_per_mps2.isZero(0.0));
}

TEST_CASE("mistakes are refused with line, column and key") {
  const struct {
    const char* text;
    const char* where;
    const char* named;
  } cases[] = {
      {"[gyros]\n", ":1:", "did you mean 'gyro'?"},
      {"gyro = 1\n", ":1:8", "must be a section"},
      {"[gyro]\nbias_sigma = 1\n", ":2:1", "unknown key 'bias_sigma'"},
      {"[gyro]\nbias_sigma_mps2 = 1\n", ":2:1", "Accepted: bias_deg_per_h"},
      {"[accelerometer]\nnoise_ug_sqrt_hz = 1\n", ":2:1", "did you mean 'noise_ug_per_sqrt_hz'?"},
      {"[accelerometer]\nbias_sigma_mg = \"1\"\n", ":2:17", "'bias_sigma_mg' has another type"},
      {"[accelerometer]\nbias_sigma_mg = [1, 2, 3]\n", ":2:17", "another type"},
      {"[accelerometer]\nbias_mg = 1\n", ":2:11", "must be 3 entries"},
      {"[accelerometer]\nbias_mg = [1, 2]\n", ":2:11", "[x, y, z]"},
      {"[accelerometer]\nbias_mg = [1, 2, true]\n", ":2:18", "another type"},
      {"[accelerometer]\nbias_sigma_mg = -1\n", ":2:17", "is -1: must be a number from 0 to 1000"},
      {"[accelerometer]\nbias_sigma_mg = nan\n", ":2:17", "is nan"},
      {"[accelerometer]\nbias_sigma_mps2 = 100\n", ":2:19", "is 100"},
      {"[accelerometer]\nrange_g = 0\n", ":2:11", "'range_g' is 0"},
      {"[accelerometer]\nbias_sigma_mg = 1\nbias_sigma_ug = 1\n", ":", "same quantity"},
      {"[accelerometer]\nin_run_tau_s = 100\n", ":2:1", "needs both"},
      {"[accelerometer]\nin_run_sigma_mg = 1\n", ":2:1", "needs both"},
      {"[gyro]\nmisalignment_mrad = [1, 2, 3, 4]\n", ":2:21", "six of them"},
      {"[gyro]\nmisalignment_mrad = [[1, 0, 0], [0, 0, 0], [0, 0, 0]]\n", ":2:21", "scale_ppm"},
      {"[gyro]\ng_sensitivity_deg_per_h_per_g = [1, 2, 3]\n", ":2:34", "3 entries"},
      {"[gyro\n", ":1:", "model.toml"},
      {"[gyro]\nrange_deg_per_s = 1\nrange_deg_per_s = 2\n", ":3:", "model.toml"},
      {"", "", "is empty"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.text);
    const std::string message = refusal(c.text);
    CAPTURE(message);
    CHECK(contains(message, std::string("model.toml") + c.where));
    CHECK(contains(message, c.named));
  }
}

TEST_CASE("spreads from unit to unit") {
  const ImuErrorModel m = model_of(R"(
[accelerometer]
scale_sigma_ppm = 300
misalignment_sigma_mrad = 0.5
[gyro]
scale_sigma_percent = 0.1
misalignment_sigma_deg = 0.05
g_sensitivity_sigma_deg_per_h_per_g = 2
)");
  CHECK(near(m.accelerometer.scale_sigma, 3e-4, 1e-19));
  CHECK(near(m.accelerometer.misalignment_sigma_rad, 5e-4, 1e-18));
  CHECK(near(m.gyro.scale_sigma, 1e-3, 1e-18));
  CHECK(near(m.gyro.misalignment_sigma_rad, 0.05 * kRadPerDeg, 1e-17));
  CHECK(near(m.G_g_sigma_radps_per_mps2, 2.0 * kRadPerDeg / 3600.0 / 9.80665, 1e-21));
  CHECK(m.accelerometer.M == Eigen::Matrix3d::Identity());
}

TEST_CASE("a value that no real sensor has is refused with the unit that was likely meant") {
  const struct {
    const char* text;
    const char* named;
  } cases[] = {
      {"[gyro]\nbias_sigma = 5\n", "it needs its unit: bias_sigma_deg_per_h"},
      {"[accelerometer]\nnoise = 60\n", "it needs its unit: noise_ug_per_sqrt_hz, noise_mps_"},
      {"[gyro]\nbias_sigma_deg_per_s = 25\n", "0 to 10; did you mean 'bias_sigma_deg_per_h'?"},
      {"[gyro]\nbias_sigma_radps = 2\n", "'bias_sigma_deg_per_h' or 'bias_sigma_deg_per_s'?"},
      {"[gyro]\nnoise_deg_per_sqrt_h = 1e-6\n", "must be 0, or at least 1e-05"},
      {"[gyro]\nnoise_dps_per_sqrt_hz = 2\n", "did you mean 'noise_deg_per_sqrt_h'?"},
      {"[accelerometer]\nnoise_mps_per_sqrt_h = 35\n", "did you mean 'noise_ug_per_sqrt_hz'?"},
      {"[accelerometer]\nnoise_ug_per_sqrt_hz = 0.03\n", "did you mean 'noise_mps_per_sqrt_h'?"},
      {"[accelerometer]\nbias_sigma_ug = 0.05\n", "'bias_sigma_mps2' or 'bias_sigma_mg'?"},
      {"[accelerometer]\nscale_sigma_ppm = 0.05\n", "did you mean 'scale_sigma_percent'?"},
      {"[gyro]\nscale_sigma_percent = 300\n", "did you mean 'scale_sigma_ppm'?"},
      {"# nothing\n", "needs [accelerometer] or [gyro]"},
  };
  for (const auto& c : cases) {
    const std::string message = refusal(c.text);
    CAPTURE(std::string(c.text));
    CAPTURE(message);
    CHECK(contains(message, c.named));
  }
}

TEST_CASE("the examples are models") {
  for (const char* name : {"automotive-mems.toml", "tactical-complete.toml"}) {
    CHECK_NOTHROW(read_imu_model(std::filesystem::path(LEEWAY_MODELS_DIR) / name));
  }
}

TEST_CASE("a file that is missing or a folder is refused by name") {
  const TempDir dir;
  for (const auto& path : {dir / "missing.toml", dir / ""}) {
    const std::string message = test::message_of<Error>([&path] { read_imu_model(path); });
    CHECK(contains(message, path.string()));
  }
}

}  // namespace
}  // namespace leeway::sim
