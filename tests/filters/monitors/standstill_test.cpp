#include "leeway/monitors/standstill.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "tests/filters/navigator/car.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::near;

/// A filter at rest that knows its velocity to 0.02 m/s and its gyro bias to 1e-4 rad/s.
Ekf filter_of_speed(double speed_mps) {
  Estimate estimate = test::truth_estimate(sim::static_trajectory(), 0.0);
  estimate.nav.v_e_mps.x() = speed_mps;
  ErrorMatrix P = ErrorMatrix::Identity();
  P.block<3, 3>(kDv, kDv) *= 0.02 * 0.02;
  P.block<3, 3>(kBg, kBg) *= 1e-8;
  return Ekf(EkfConfig{}, estimate, P);
}

/// As an idling car gives it, of a hundred increments.
ImuBlock calm_block() {
  ImuBlock block;
  block.dt_s = 0.5;
  block.count = 50;
  block.gyro_std_radps = 0.0008;
  block.force_std_mps2 = 0.02;
  return block;
}

bool second_block_at_rest(const ImuBlock& block, const Ekf& filter) {
  StandstillDetector detector(StandstillConfig{}, ImuErrorModel{});
  CHECK_FALSE(detector.push(block, filter));
  return detector.push(block, filter);
}

/// How often in a hundred seconds, the first five aside, the car is taken for resting.
int times_at_rest(const sim::Trajectory& trajectory, std::uint64_t seed) {
  constexpr double kSampleHz = 50.0;
  const auto log = test::record(trajectory, sim::true_increments(trajectory, kSampleHz, 100.0),
                                automotive_mems_model(), {}, 0.5, 0.5, seed);
  NavigatorConfig config;
  config.vehicle = VehicleConfig::car();
  config.vehicle.rear_axle_x_m = 0.0;
  Navigator navigator(config);
  const Estimate start = test::truth_estimate(trajectory, 0.0);
  navigator.start(start, initial_covariance(start, {0.02, 0.05, 0.1, 2.0}, config.filter.imu));
  int count = 0;
  std::size_t next = 0;
  for (const ImuIncrement& inc : log.imu) {
    for (; next < log.fixes.size() && log.fixes[next].time <= inc.time; ++next) {
      navigator.push(log.fixes[next]);
    }
    navigator.push(inc);
    count += inc.time > time_from_seconds(5.0) && navigator.health().at_rest;
  }
  return count;
}

}  // namespace

TEST_CASE("blocks of half a second: their mean and spread, by two passes over the same data") {
  for (const double rate_hz : {10.0, 99.5, 400.0}) {
    CAPTURE(rate_hz);
    sim::Random random(1);
    ImuBlocks blocks;
    std::vector<Eigen::Vector3d> rates;
    int completed = 0;
    for (int k = 1; k <= static_cast<int>(5.0 * rate_hz); ++k) {
      const double dt_s = 1.0 / rate_hz;
      const Eigen::Vector3d rate = Eigen::Vector3d(0.3, -0.1, 0.2) + 0.01 * random.normal3();
      rates.push_back(rate);
      const auto block =
          blocks.push({time_from_seconds(k * dt_s), dt_s, dt_s * rate, dt_s * (10.0 * rate)});
      if (!block) continue;
      ++completed;
      Eigen::Vector3d mean = Eigen::Vector3d::Zero();
      for (const Eigen::Vector3d& r : rates) mean += r / static_cast<double>(rates.size());
      double square = 0.0;
      for (const Eigen::Vector3d& r : rates) square += (r - mean).squaredNorm();
      const double spread = std::sqrt(square / static_cast<double>(rates.size()));
      CHECK(block->count == static_cast<int>(rates.size()));
      CHECK(block->time == time_from_seconds(k * dt_s));
      CHECK(near(block->dt_s, ImuBlocks::kBlockS, 0.5 * dt_s + 1e-12));
      CHECK(near(block->mean_omega_ib_b_radps, mean, 1e-14));
      // A sum of squares of 0.14 less that of its mean: 1e-17 in 1e-4.
      CHECK(near(block->gyro_std_radps, spread, 1e-12));
      CHECK(near(block->force_std_mps2, 10.0 * spread, 1e-11));
      rates.clear();
    }
    CHECK(completed >= 9);
  }
}

TEST_CASE("two calm blocks are a rest, one is not; one that is not calm ends it") {
  StandstillDetector detector(StandstillConfig{}, ImuErrorModel{});
  const Ekf filter = filter_of_speed(0.0);
  ImuBlock shaken = calm_block();
  shaken.force_std_mps2 = 0.3;
  CHECK_FALSE(detector.push(calm_block(), filter));
  CHECK(detector.push(calm_block(), filter));
  CHECK(detector.push(calm_block(), filter));
  CHECK_FALSE(detector.push(shaken, filter));
  CHECK_FALSE(detector.push(calm_block(), filter));
  CHECK(detector.push(calm_block(), filter));
}

TEST_CASE("each of vibration, turn and speed is enough to refuse a rest") {
  CHECK(second_block_at_rest(calm_block(), filter_of_speed(0.0)));
  CHECK(second_block_at_rest(calm_block(), filter_of_speed(0.25)));
  // 0.3 m/s and three sigma of three axes: 0.4 m/s.
  CHECK_FALSE(second_block_at_rest(calm_block(), filter_of_speed(0.45)));
  ImuBlock block = calm_block();
  block.gyro_std_radps = 0.0021;
  CHECK_FALSE(second_block_at_rest(block, filter_of_speed(0.0)));
  block = calm_block();
  block.force_std_mps2 = 0.061;
  CHECK_FALSE(second_block_at_rest(block, filter_of_speed(0.0)));
  block = calm_block();
  block.mean_omega_ib_b_radps.z() = 0.006;  // 0.34 deg/s; the bias is known to 0.0005
  CHECK_FALSE(second_block_at_rest(block, filter_of_speed(0.0)));
  block.mean_omega_ib_b_radps.z() = 0.004;
  CHECK(second_block_at_rest(block, filter_of_speed(0.0)));
}

TEST_CASE("white noise of the IMU alone is not motion, at any rate") {
  ImuErrorModel noisy = automotive_mems_model();
  noisy.gyro.noise_density *= 10.0;
  noisy.accelerometer.noise_density *= 10.0;
  const sim::Trajectory rest = sim::static_trajectory();
  for (const double rate_hz : {20.0, 100.0, 200.0}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      CAPTURE(rate_hz);
      CAPTURE(seed);
      ImuErrorModel unbiased = noisy;
      unbiased.gyro.bias_sigma = 0.0;
      sim::ImuErrorSimulator sensor(unbiased, sim::Random(seed));
      StandstillDetector detector(StandstillConfig{}, noisy);
      const Ekf filter = filter_of_speed(0.0);
      ImuBlocks blocks;
      int at_rest = 0;
      int count = 0;
      for (const ImuIncrement& inc : sim::true_increments(rest, rate_hz, 50.0)) {
        const auto block = blocks.push(sensor.measure(inc));
        if (!block) continue;
        ++count;
        at_rest += detector.push(*block, filter);
      }
      // 1.5 times the standard deviation of 30 numbers is 4 sigma; the mean's 3 sigma are 1 %.
      CHECK(at_rest > count * 9 / 10);
    }
  }
}

TEST_CASE("a car that stands is at rest after a second") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    NavigatorConfig config;
    config.vehicle = VehicleConfig::car();
    config.vehicle.rear_axle_x_m = 0.0;
    Navigator navigator = test::started_car(config);
    double first_s = 0.0;
    run(navigator, test::drive({}, seed), 14.0, {}, [&](const ImuIncrement& inc) {
      if (first_s == 0.0 && navigator.health().at_rest) first_s = to_seconds(inc.time);
    });
    // A fix within the first block may move the velocity by more than a car at rest does.
    CHECK(first_s > 0.9);
    CHECK(first_s < 2.1);
    CHECK(navigator.health().at_rest);
    // What a rest teaches: the gyro bias, to the sigma of a rate that may be 2e-5 rad/s.
    CHECK(navigator.solution().sigma_b_g_radps.maxCoeff() < 2e-4);
    CHECK(navigator.filter().estimate().nav.v_e_mps.norm() < 0.1);
  }
}

TEST_CASE("creeping is no rest, however smooth: straight on and in a slow turn" *
          doctest::test_suite("heavy")) {
  // 2026-11-24: on a recorded drive the spread of half a second was that of a stop.
  const sim::Trajectory straight = sim::straight({.ground_speed_mps = 1.0});
  const sim::Trajectory turn =
      sim::circle({.radius_m = 1.0 / (5.0 * kRadPerDeg), .speed_mps = 1.0});
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    CHECK(times_at_rest(straight, seed) == 0);
    CHECK(times_at_rest(turn, seed) == 0);
    CHECK(times_at_rest(sim::static_trajectory(), seed) > 90 * 50);
  }
}

TEST_CASE("limits that are not positive are refused by name") {
  const auto message = [](auto spoil) {
    StandstillConfig config;
    spoil(config);
    return test::message_of<Error>([&] { StandstillDetector(config, ImuErrorModel{}); });
  };
  CHECK(test::contains(message([](auto& c) { c.gyro_std_radps = 0.0; }), "gyro_std_radps"));
  CHECK(test::contains(message([](auto& c) { c.force_std_mps2 = -1.0; }), "force_std_mps2"));
  CHECK(test::contains(message([](auto& c) { c.turn_radps = 0.0; }), "turn_radps"));
  CHECK(test::contains(
      message([](auto& c) { c.speed_mps = std::numeric_limits<double>::infinity(); }),
      "speed_mps"));
}

}  // namespace leeway
