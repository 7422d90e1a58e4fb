#include "leeway/monitors/imu_screen.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <random>

namespace leeway {
namespace {

constexpr double kStepS = 0.01;

/// Noise on all six axes, for so many increments.
class Sensor {
 public:
  ImuIncrement next() {
    ImuIncrement inc;
    inc.dt_s = kStepS;
    for (int i = 0; i < 3; ++i) {
      inc.dtheta_b_rad(i) = kStepS * 0.002 * normal_(random_);
      inc.dv_b_mps(i) = kStepS * 0.05 * normal_(random_);
    }
    return inc;
  }

 private:
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_{};
};

/// How long until it is told, s; negative: never.
double told_after_s(const std::function<void(ImuIncrement&)>& fault) {
  Sensor sensor;
  ImuScreen screen;
  for (int k = 0; k < 1000; ++k) CHECK_FALSE(screen.is_held(sensor.next()));
  for (int k = 0; k < 1000; ++k) {
    ImuIncrement inc = sensor.next();
    fault(inc);
    if (screen.is_held(inc)) return k * kStepS;
  }
  return -1.0;
}

TEST_CASE("an axis at the end of its range is told after a quarter of a second") {
  // The values of a rate times a step that jitters, so that the increments differ.
  int k = 0;
  const double s = told_after_s([&k](ImuIncrement& inc) {
    inc.dt_s = kStepS * (1.0 + 1e-3 * (k++ % 7));
    inc.dtheta_b_rad.z() = 0.0873 * inc.dt_s;
  });
  CHECK(s == doctest::Approx(ImuScreen::kHeldS).epsilon(0.05));  // a step of 0.01 s
}

TEST_CASE("a triad of zeros is told") {
  CHECK(told_after_s([](ImuIncrement& inc) { inc.dtheta_b_rad.setZero(); }) > 0.0);
}

TEST_CASE("noise of as much as a step of the converter is none") {
  // Quantized to half a sigma, two values in five are like the one before.
  CHECK(told_after_s([](ImuIncrement& inc) {
          constexpr double kStep = 0.001 * kStepS;
          for (double& axis : inc.dtheta_b_rad) axis = kStep * std::round(axis / kStep);
        }) < 0.0);
}

TEST_CASE("an axis that has never changed is a simulation's") {
  ImuScreen screen;
  Sensor sensor;
  for (int k = 0; k < 1000; ++k) {
    ImuIncrement inc = sensor.next();
    inc.dtheta_b_rad.x() = 0.0;
    CHECK_FALSE(screen.is_held(inc));
  }
}

}  // namespace
}  // namespace leeway
