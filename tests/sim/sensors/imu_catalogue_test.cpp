#include "leeway/sim/sensors/imu_catalogue.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

using test::contains;
using test::near;

std::string number(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// A cell of the guide's table: the number as printed, * where it is assumed, - where there is
/// none.
std::string cell(const ImuPart& part, Triad triad, ModelField field) {
  const auto found =
      std::find_if(part.values.begin(), part.values.end(),
                   [=](const DatasheetValue& v) { return v.triad == triad && v.field == field; });
  if (found == part.values.end()) return "-";
  return number(found->printed) + " " + std::string(found->unit->symbol) +
         (found->meaning == Meaning::kAssumed ? " *" : "");
}

std::string row_of_values(const ImuPart& part, Triad triad) {
  std::string row = "| " + std::string(part.name) + " |";
  for (const ModelField field :
       {ModelField::kBiasSigma, ModelField::kInRunSigma, ModelField::kInRunTau, ModelField::kNoise,
        ModelField::kScaleSigma, ModelField::kMisalignmentSigma}) {
    row += " " + cell(part, triad, field) + " |";
  }
  if (triad == Triad::kGyro) row += " " + cell(part, triad, ModelField::kGSensitivitySigma) + " |";
  return row;
}

std::string row_of_source(const ImuPart& part) {
  std::string row = "|";
  for (const std::string_view text :
       {part.name, part.manufacturer, name(part.grade), name(classify(imu_model(part)).overall),
        part.technology, part.datasheet, part.checked}) {
    row += " " + std::string(text) + " |";
  }
  return row;
}

}  // namespace

TEST_CASE("catalogue: at least 15 parts, each whole and from a named datasheet") {
  CHECK(imu_parts().size() >= 15);
  std::set<Grade> grades;
  for (const ImuPart& part : imu_parts()) {
    CAPTURE(part.name);
    CHECK_NOTHROW(imu_model(part));
    CHECK(!part.manufacturer.empty());
    CHECK(part.datasheet.size() > part.name.size());
    CHECK(!part.checked.empty());
    grades.insert(part.grade);
    const ImuErrorModel model = imu_model(part);
    for (const TriadErrorModel& triad : {model.accelerometer, model.gyro}) {
      CHECK(triad.bias_sigma > 0.0);
      CHECK(triad.noise_density > 0.0);
      CHECK((triad.in_run.sigma > 0.0) == std::isfinite(triad.in_run.tau_s));
    }
    std::set<std::pair<Triad, ModelField>> fields;
    for (const DatasheetValue& value : part.values) {
      CAPTURE(value.quantity);
      CHECK(value.printed > 0.0);
      CHECK(!value.quantity.empty());
      CHECK(fields.insert({value.triad, value.field}).second);
    }
  }
  CHECK(grades.size() == 4);
}

TEST_CASE("catalogue: the unit of a value is one of its field") {
  for (const ImuPart& part : imu_parts()) {
    for (const DatasheetValue& value : part.values) {
      CAPTURE(part.name);
      CAPTURE(value.quantity);
      const bool is_gyro = value.triad == Triad::kGyro;
      const std::string_view si = value.unit->si_symbol;
      switch (value.field) {
        case ModelField::kBiasSigma:
        case ModelField::kInRunSigma:
          CHECK(si == (is_gyro ? "rad/s" : "m/s^2"));
          break;
        case ModelField::kInRunTau:
          CHECK(si == "s");
          break;
        case ModelField::kNoise:
          CHECK(si == (is_gyro ? "rad/s/sqrt(Hz)" : "m/s^2/sqrt(Hz)"));
          break;
        case ModelField::kScaleSigma:
          CHECK(si == "1");
          break;
        case ModelField::kMisalignmentSigma:
          CHECK((si == "rad" || si == "1"));  // a cross-axis sensitivity is a ratio
          break;
        case ModelField::kGSensitivitySigma:
          CHECK(si == "rad/s/(m/s^2)");
          CHECK(is_gyro);
          break;
      }
    }
  }
}

TEST_CASE("catalogue: a model by hand") {
  // STIM300: 0.75 mg, 0.05 mg, 0.06 m/s/sqrt(h), 300 ppm, 1 mrad; 5 deg/h, 0.5 deg/h,
  // 0.15 deg/sqrt(h), 500 ppm, 1 mrad, 1 deg/h/g.
  const ImuErrorModel m = imu_model(imu_part("STIM300"));
  const auto close = [](double value, double wanted) {
    return near(value, wanted, 1e-14 * wanted);  // a few roundings
  };
  CHECK(close(m.accelerometer.bias_sigma, 0.75e-3 * 9.80665));
  CHECK(close(m.accelerometer.in_run.sigma, 0.05e-3 * 9.80665 / kAllanPeak));
  CHECK(m.accelerometer.in_run.tau_s == 1000.0);
  CHECK(close(m.accelerometer.noise_density, 1e-3));
  CHECK(close(m.accelerometer.scale_sigma, 3e-4));
  CHECK(close(m.accelerometer.misalignment_sigma_rad, 1e-3));
  CHECK(close(m.gyro.bias_sigma, 5.0 * kRadPerDeg / 3600.0));
  CHECK(close(m.gyro.in_run.sigma, 0.5 * kRadPerDeg / 3600.0 / kAllanPeak));
  CHECK(close(m.gyro.noise_density, 0.0025 * kRadPerDeg));
  CHECK(close(m.gyro.scale_sigma, 5e-4));
  CHECK(close(m.G_g_sigma_radps_per_mps2, kRadPerDeg / 3600.0 / 9.80665));
  // A guaranteed maximum is three sigma: 2 deg/h of the KVH 1750.
  CHECK(close(imu_model(imu_part("KVH 1750")).gyro.bias_sigma, 2.0 / 3.0 * kRadPerDeg / 3600.0));
}

TEST_CASE("catalogue: the Allan deviation of a Gauss-Markov process peaks at kAllanPeak sigma") {
  // Averages of the process over two adjoining intervals of length x, correlation time 1:
  // half the mean square of their difference, from the covariances integrated numerically.
  const auto allan_deviation = [](double x) {
    constexpr int kCells = 400;
    double within = 0.0;
    double across = 0.0;
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        within += std::exp(-std::abs(i - j) * x / kCells);
        across += std::exp(-(kCells + j - i) * x / kCells);
      }
    }
    return std::sqrt((within - across) / (kCells * kCells));
  };
  double peak = 0.0;
  for (double x = 1.5; x < 2.3; x += 0.05) peak = std::max(peak, allan_deviation(x));
  // Cells of x/400: relative error of their sum (x/400)^2 / 12, and 1e-4 for the step of x.
  CHECK(near(peak, kAllanPeak, 2e-4));
}

TEST_CASE("catalogue: names are forgiving, unknown ones are refused with the closest") {
  for (const char* text : {"stim300", "STIM-300", "stim 300", "Stim_300"}) {
    CHECK(imu_part(text).name == "STIM300");
  }
  CHECK(imu_part("kvh1750").name == "KVH 1750");
  CHECK(imu_part("icm42688p").name == "ICM-42688-P");
  const std::string message = test::message_of<Error>([] { imu_part("adis16471"); });
  CHECK(contains(message, "unknown IMU 'adis16471': did you mean 'ADIS16470'?"));
  CHECK(contains(message, "HG9900"));
  CHECK(!test::message_of<Error>([] { imu_part(""); }).empty());
}

TEST_CASE("catalogue: parts fall into the classes that they are sold as") {
  const auto class_of = [](const char* part) {
    return classify(imu_model(imu_part(part))).overall;
  };
  CHECK(class_of("ICM-20948") == ImuClass::kAutomotive);
  CHECK(class_of("LN-200") == ImuClass::kTactical);
  CHECK(class_of("HG1700") == ImuClass::kTactical);
  CHECK(class_of("HG9900") == ImuClass::kAviation);
  // The order of the list: no grade comes before a lesser one.
  const auto parts = imu_parts();
  CHECK(std::is_sorted(parts.begin(), parts.end(),
                       [](const ImuPart& a, const ImuPart& b) { return a.grade < b.grade; }));
}

TEST_CASE("catalogue: values of a model, in the units of datasheets, give the model back") {
  const ImuErrorModel wanted = imu_model(imu_part("STIM300"));
  const auto values = datasheet_values(wanted);
  CHECK(values.size() == 13);
  ImuPart part;
  part.values = values;
  const ImuErrorModel model = imu_model(part);
  const auto close = [](double a, double b) { return near(a, b, 4e-16 * b); };
  CHECK(close(model.gyro.bias_sigma, wanted.gyro.bias_sigma));
  CHECK(close(model.accelerometer.noise_density, wanted.accelerometer.noise_density));
  CHECK(close(model.G_g_sigma_radps_per_mps2, wanted.G_g_sigma_radps_per_mps2));
  CHECK(datasheet_values(ImuErrorModel{}).empty());
}

TEST_CASE("catalogue: the guide shows every part as it is") {
  const std::string guide = test::read_file(LEEWAY_GUIDE_DIR "/imu-catalogue.md");
  for (const ImuPart& part : imu_parts()) {
    for (const std::string& row : {row_of_source(part), row_of_values(part, Triad::kGyro),
                                   row_of_values(part, Triad::kAccelerometer)}) {
      CAPTURE(row);
      CHECK(contains(guide, "\n" + row + "\n"));
    }
  }
}

}  // namespace leeway::sim
