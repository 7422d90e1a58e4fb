#include "leeway/strapdown/integration_monitor.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "leeway/earth/error.hpp"
#include "tests/support/allocation_counter.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;

constexpr double kRunS = 30.0;
constexpr double kAngleRad = 2e-3;
constexpr double kForceMps2 = 15.0;

double phase_rad(double frequency_hz, double rate_hz) {
  return 2.0 * std::numbers::pi * frequency_hz / rate_hz;
}

/// Coning about z, and a force along y in phase with the turn about x: sculling along z. Integrals
/// in closed form.
IntegrationMonitor shaken(double frequency_hz, double rate_hz) {
  const double w = 2.0 * std::numbers::pi * frequency_hz;
  IntegrationMonitor monitor;
  for (int k = 1; k <= kRunS * rate_hz; ++k) {
    const double from = w * (k - 1) / rate_hz;
    const double to = w * k / rate_hz;
    ImuIncrement inc;
    inc.time = time_from_seconds(k / rate_hz);
    inc.dt_s = 1.0 / rate_hz;
    inc.dtheta_b_rad = kAngleRad * Eigen::Vector3d(std::sin(to) - std::sin(from),
                                                   std::cos(to) - std::cos(from), 0.0);
    inc.dv_b_mps.y() = kForceMps2 / w * (std::cos(from) - std::cos(to));
    monitor.push(inc);
  }
  return monitor;
}

/// Savage (1998): the share of a vibration that one sample leaves out.
double one_sample_share(double x) { return 1.0 - std::sin(x) / x; }

/// And two samples, whose 1/12 of the cross product gives this much back.
double two_sample_share(double x) {
  return one_sample_share(x) - 2.0 / 3.0 * std::pow(std::sin(0.5 * x), 2) * std::sin(x) / x;
}

}  // namespace

TEST_CASE("integration monitor: coning and sculling left out, by closed forms") {
  for (const double frequency_hz : {5.0, 8.0, 11.0}) {
    CAPTURE(frequency_hz);
    const double x = phase_rad(frequency_hz, 100.0);
    const IntegrationMonitor monitor = shaken(frequency_hz, 100.0);
    const double coning = kAngleRad * kAngleRad * std::numbers::pi * frequency_hz;
    const double sculling = 0.5 * kAngleRad * kForceMps2;
    const LeftOut one = monitor.left_out(Scheme::kOneSample);
    const LeftOut two = monitor.left_out(Scheme::kTwoSample);
    // The series' own remainder up to 40 deg of phase is 1 and 10 %; what is left of the vibration
    // in a mean over ten seconds is below a hundredth.
    CHECK(near(one.rate_b_radps.norm() / (coning * one_sample_share(x)), 1.0, 0.02));
    CHECK(near(one.force_b_mps2.norm() / (sculling * one_sample_share(x)), 1.0, 0.02));
    CHECK(near(two.rate_b_radps.norm() / (coning * two_sample_share(x)), 1.0, 0.12));
    CHECK(near(two.force_b_mps2.norm() / (sculling * two_sample_share(x)), 1.0, 0.12));
    // Both are about or along z.
    CHECK(std::abs(one.rate_b_radps.z()) > 0.99 * one.rate_b_radps.norm());
  }
}

TEST_CASE("integration monitor: explicit Euler takes the force half an increment late") {
  // A level turn: 0.2 rad/s at 20 m/s.
  IntegrationMonitor monitor;
  for (int k = 1; k <= 1000; ++k) {
    monitor.push({time_from_seconds(0.01 * k), 0.01, Eigen::Vector3d(0.0, 0.0, 0.002),
                  Eigen::Vector3d(0.0, 0.04, -0.098)});
  }
  const Eigen::Vector3d left_out_b_mps2 = monitor.left_out(Scheme::kExplicitEuler).force_b_mps2 -
                                          monitor.left_out(Scheme::kOneSample).force_b_mps2;
  // T/2 omega x f, exact but for rounding.
  CHECK(near(left_out_b_mps2, Eigen::Vector3d(-0.5 * 0.01 * 0.2 * 4.0, 0.0, 0.0), 1e-12));
}

TEST_CASE("integration monitor: motion that increments do not resolve, aliases included") {
  CHECK(shaken(10.0, 100.0).resolves_motion());
  CHECK(shaken(16.0, 100.0).resolves_motion());
  CHECK_FALSE(shaken(17.5, 100.0).resolves_motion());
  CHECK_FALSE(shaken(40.0, 100.0).resolves_motion());
  CHECK_FALSE(shaken(60.0, 50.0).resolves_motion());  // looks like 10 Hz
}

TEST_CASE("integration monitor: white noise is not motion") {
  ImuErrorModel imu;
  imu.gyro.noise_density = 1e-4;
  imu.accelerometer.noise_density = 1e-3;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    std::mt19937 engine(seed);
    std::normal_distribution<double> unit;
    IntegrationMonitor monitor(imu);
    for (int k = 1; k <= 3000; ++k) {
      ImuIncrement inc{time_from_seconds(0.01 * k), 0.01, {}, {}};
      for (int i = 0; i < 3; ++i) {
        inc.dtheta_b_rad(i) = 1e-4 * 0.1 * unit(engine);
        inc.dv_b_mps(i) = 1e-3 * 0.1 * unit(engine);
      }
      monitor.push(inc);
    }
    CHECK(monitor.resolves_motion());
    // Of a cross product of noise, 1e-8 rad^2/s / 12 per sample, a thousand samples leave 5e-11.
    CHECK(monitor.left_out(Scheme::kOneSample).rate_b_radps.norm() < 5e-10);
  }
}

TEST_CASE("integration monitor: nothing in the first second, no heap, a bad model refused") {
  IntegrationMonitor monitor;
  const test::AllocationCounter allocations;
  for (int k = 1; k <= 50; ++k) {
    monitor.push({time_from_seconds(0.01 * k), 0.01, Eigen::Vector3d(0.01 * (k % 2), 0.01, 0.0),
                  Eigen::Vector3d(0.0, 0.1, -0.1)});
  }
  CHECK(monitor.left_out(Scheme::kExplicitEuler).force_b_mps2.isZero(0.0));
  CHECK(monitor.resolves_motion());
  CHECK(allocations.count() == 0);
  ImuErrorModel bad;
  bad.gyro.noise_density = -1.0;
  CHECK_THROWS_AS(IntegrationMonitor{bad}, Error);
}

}  // namespace leeway
