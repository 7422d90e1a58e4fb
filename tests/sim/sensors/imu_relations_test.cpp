#include "sim/sensors/imu_relations.hpp"

#include <doctest/doctest.h>

#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/sensors/imu_catalogue.hpp"
#include "leeway/sim/sensors/imu_model_file.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

double stated(const ImuErrorModel& model, Stated quantity) {
  const TriadErrorModel& a = model.accelerometer;
  const TriadErrorModel& g = model.gyro;
  const double in_order[] = {a.bias_sigma, a.in_run.sigma, a.noise_density,
                             g.bias_sigma, g.in_run.sigma, g.noise_density};
  return in_order[static_cast<std::size_t>(quantity)];
}

/// Whether every relation holds, and would hold with bounds that are that factor narrower.
bool holds(const ImuErrorModel& model, double room) {
  for (Relation relation : kRelations) {
    relation.low *= room;
    relation.high /= room;
    const double over = stated(model, relation.over);
    const double under = stated(model, relation.under);
    if (!relation.allows(over, under)) {
      MESSAGE(over << " / " << under << " is outside " << relation.low << " .. " << relation.high);
      return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("relations: no part, class or example comes within a factor of 2 of a bound") {
  constexpr double kRoom = 2.0;
  for (const ImuPart& part : imu_parts()) {
    CAPTURE(part.name);
    CHECK(holds(imu_model(part), kRoom));
  }
  for (const ImuClass c : kAll<ImuClass>) {
    for (const RangeEnd end : kAll<RangeEnd>) {
      CAPTURE(name(c));
      CHECK(holds(imu_class_model(c, end), kRoom));
    }
  }
  CHECK(holds(automotive_mems_model(), kRoom));
}

TEST_CASE("relations: a slip of a unit beside right values is refused with the likely intent") {
  const struct {
    const char* text;
    const char* message;
  } cases[] = {
      // 5 deg/h and 0.5 deg/h of a STIM300, 3600x.
      {"[gyro]\nbias_sigma_deg_per_s = 5\nnoise_deg_per_sqrt_h = 0.15\n", "'bias_sigma_deg_per_h'"},
      {"[gyro]\nin_run_sigma_deg_per_s = 0.5\nin_run_tau_s = 1000\nnoise_deg_per_sqrt_h = 0.15\n",
       "'in_run_sigma_deg_per_h'"},
      // 0.15 deg/sqrt(h), 60x, beside 0.3 deg/h and beside the accelerometer's noise.
      {"[gyro]\nin_run_sigma_deg_per_h = 0.3\nin_run_tau_s = 1000\nnoise_dps_per_sqrt_hz = 0.15\n",
       "'noise_deg_per_sqrt_h'"},
      {"[accelerometer]\nnoise_mps_per_sqrt_h = 0.06\n[gyro]\nnoise_dps_per_sqrt_hz = 0.15\n",
       "'noise_deg_per_sqrt_h'"},
      // 300 ug as mg, 0.75 mg as ug, 1000x.
      {"[accelerometer]\nbias_sigma_mg = 300\nnoise_ug_per_sqrt_hz = 35\n", "'bias_sigma_ug'"},
      {"[accelerometer]\nbias_sigma_ug = 0.75\nnoise_mps_per_sqrt_h = 0.06\n", "'bias_sigma_mg'"},
      {"[accelerometer]\nin_run_sigma_mg = 25\nin_run_tau_s = 1000\nnoise_ug_per_sqrt_hz = 8\n",
       "'in_run_sigma_ug'"},
      // Tactical accelerometers with a gyro 3600 times too bad.
      {"[accelerometer]\nbias_sigma_mg = 1\n[gyro]\nbias_sigma_deg_per_s = 1\n",
       "'bias_sigma_deg_per_h'"},
  };
  for (const auto& c : cases) {
    CAPTURE(std::string(c.text));
    const std::string message =
        test::message_of<Error>([&c] { parse_imu_model(c.text, "model.toml"); });
    CAPTURE(message);
    CHECK(test::contains(message, "model.toml:"));
    CHECK(test::contains(message, "no real sensor has both; did you mean "));
    CHECK(test::contains(message, c.message));
  }
}

TEST_CASE("relations: zero goes with everything") {
  CHECK_NOTHROW(
      parse_imu_model("[gyro]\nbias_sigma_deg_per_s = 5\nnoise_deg_per_sqrt_h = 0\n"
                      "[accelerometer]\nbias_sigma_mg = 0\n",
                      "model.toml"));
}

}  // namespace leeway::sim
