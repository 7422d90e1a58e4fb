#include "leeway/sensors/imu_class.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <string>

#include "leeway/earth/error.hpp"

namespace leeway {
namespace {

// One ulp or two of the unit conversions.
bool same(double a, double b) { return std::abs(a - b) <= 4.5e-16 * std::abs(b); }

constexpr double kUg = 9.80665e-6;  // m/s^2

// deg/sqrt(h) in rad/sqrt(s): pi / 180 / 60
constexpr double kDegPerSqrtH = 3.14159265358979323846 / 10800.0;

}  // namespace

TEST_CASE("the five classes carry the numbers of [seed Table 1]") {
  struct Row {
    ImuClass c;
    const char* name;
    double accelerometer[2];
    double gyro;
    double accelerometer_noise_ug[2];
    double gyro_noise_deg[2];
  };
  const Row rows[] = {
      {ImuClass::kMarine, "marine", {1e-4, 1e-4}, 5e-9, {5.0, 20.0}, {0.0005, 0.002}},
      {ImuClass::kAviation, "aviation", {3e-4, 1e-3}, 5e-8, {20.0, 20.0}, {0.002, 0.002}},
      {ImuClass::kIntermediate, "intermediate", {1e-3, 1e-2}, 5e-7, {20.0, 100.0}, {0.002, 0.03}},
      {ImuClass::kTactical, "tactical", {1e-2, 1e-1}, 5e-6, {100.0, 1000.0}, {0.03, 1.0}},
      {ImuClass::kAutomotive, "automotive", {1e-1, 1e-1}, 5e-4, {1000.0, 1000.0}, {1.0, 1.0}}};
  for (const Row& row : rows) {
    CAPTURE(row.name);
    CHECK(name(row.c) == row.name);
    CHECK(from_name<ImuClass>(row.name) == row.c);
    for (int i = 0; i < 2; ++i) {
      const ImuErrorModel model = imu_class_model(row.c, i == 0 ? RangeEnd::kLow : RangeEnd::kHigh);
      CHECK(same(model.accelerometer.bias_sigma, row.accelerometer[i]));
      CHECK(same(model.gyro.bias_sigma, row.gyro));
      CHECK(same(model.accelerometer.noise_density, row.accelerometer_noise_ug[i] * kUg));
      CHECK(same(model.gyro.noise_density, row.gyro_noise_deg[i] * kDegPerSqrtH));
    }
  }
}

TEST_CASE("the middle of a class is the geometric mean of its range") {
  // As printed, four digits, with the defined case of the correction interval.
  const double accelerometer[] = {1e-4, 5.477e-4, 3.162e-3, 3.162e-2, 1e-1};
  const double gyro[] = {5e-9, 5e-8, 5e-7, 5e-6, 5e-4};
  const double accelerometer_noise_ug[] = {10.0, 20.0, 44.7, 316.0, 1000.0};
  const double gyro_noise_deg[] = {0.001, 0.002, 0.00775, 0.173, 1.0};
  const auto printed_as = [](double value, double printed, double half_digit) {
    return std::abs(value - printed) <= half_digit * printed;
  };
  for (std::size_t i = 0; i < kAll<ImuClass>.size(); ++i) {
    CAPTURE(name(kAll<ImuClass>[i]));
    const ImuErrorModel model = imu_class_model(kAll<ImuClass>[i], RangeEnd::kMid);
    CHECK(printed_as(model.accelerometer.bias_sigma, accelerometer[i], 1.6e-4));
    CHECK(printed_as(model.gyro.bias_sigma, gyro[i], 1e-15));
    CHECK(printed_as(model.accelerometer.noise_density / kUg, accelerometer_noise_ug[i], 1.6e-3));
    CHECK(printed_as(model.gyro.noise_density / kDegPerSqrtH, gyro_noise_deg[i], 1.6e-3));
  }
}

TEST_CASE("a class has biases and noise and no other error") {
  for (const ImuClass c : kAll<ImuClass>) {
    for (const RangeEnd end : kAll<RangeEnd>) {
      const ImuErrorModel model = imu_class_model(c, end);
      CHECK_NOTHROW(validate(model));
      for (const TriadErrorModel& triad : {model.accelerometer, model.gyro}) {
        CHECK(triad.bias == Eigen::Vector3d::Zero());
        CHECK(triad.M == Eigen::Matrix3d::Identity());
        CHECK(triad.in_run.sigma == 0.0);
        CHECK(triad.quantum == 0.0);
        CHECK(std::isinf(triad.range));
      }
      CHECK(model.G_g_radps_per_mps2 == Eigen::Matrix3d::Zero());
    }
  }
}

TEST_CASE("every class and end of its range is classified as itself") {
  for (const ImuClass c : kAll<ImuClass>) {
    for (const RangeEnd end : kAll<RangeEnd>) {
      CAPTURE(name(c));
      CAPTURE(name(end));
      CHECK(classify(imu_class_model(c, end)).overall == c);
    }
  }
}

TEST_CASE("each quantity is classified on its own, and the worst of them is the class") {
  ImuErrorModel model = imu_class_model(ImuClass::kAviation, RangeEnd::kMid);
  model.gyro.bias_sigma = 1e-4;    // nearer to 5e-4 than to 5e-6 by logarithm: ratios 5, 20
  model.gyro.noise_density = 0.0;  // no noise is the best there is
  model.accelerometer.noise_density = 140.0 * 9.80665e-6;  // within 100 to 1000 ug
  ImuClassification c = classify(model);
  CHECK(c.accelerometer_drift == ImuClass::kAviation);
  CHECK(c.gyro_drift == ImuClass::kAutomotive);
  CHECK(c.accelerometer_noise == ImuClass::kTactical);
  CHECK(c.gyro_noise == ImuClass::kMarine);
  CHECK(c.overall == ImuClass::kAutomotive);
  model.gyro.bias_sigma = 4e-5;  // ratios 12.5, 8
  CHECK(classify(model).gyro_drift == ImuClass::kTactical);
  CHECK(classify(model).overall == ImuClass::kTactical);
  // The bias at the start is turn-on and in-run: the wandering part counts as well.
  model.gyro.bias_sigma = 0.0;
  model.gyro.in_run = {1e-4, 100.0};
  CHECK(classify(model).gyro_drift == ImuClass::kAutomotive);
}

}  // namespace leeway
