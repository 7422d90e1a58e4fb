#include "leeway/monitors/coast_monitor.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "leeway/earth/earth.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/local_trajectory.hpp"

namespace leeway {
namespace {

constexpr double kDurationS = 600.0;
constexpr double kImuRateHz = 50.0;
constexpr double kPeriodS = 52.4;  // 2 pi / 0.12: two bends
constexpr int kRuns = 5;

/// Winds about a line to the east at some 15 m/s.
const sim::Trajectory& winding() {
  static const sim::Trajectory trajectory = test::local_trajectory(kDurationS, [](double t_s) {
    const sim::Jet t = sim::time_jet(t_s);
    sim::LocalMotion m;
    m.north_m = 60.0 * sin(0.12 * t);
    m.east_m = 15.0 * t + 40.0 * sin(0.05 * t);
    m.yaw_rad = 1.57 + 0.3 * sin(0.12 * t);
    return m;
  });
  return trajectory;
}

void scale(TriadErrorModel& triad, double factor) {
  triad.noise_density *= factor;
  triad.in_run.sigma *= factor;
}

const sim::GnssErrorModel kRtk{{0.02, 0.02, 0.03}, {0.03, 0.03, 0.03}};
const sim::GnssErrorModel kCode{{1.0, 1.0, 1.5}, {0.2, 0.2, 0.2}};

struct Found {
  double imu_sigma_scale;
  double first_alarm_s;  ///< infinite where there is none
};

/// What the monitor beside a filter of the default model says of a sensor that is worse by a
/// factor, after ten minutes with a fix every second.
/// @param heading_off_rad  of the start, beyond what it claims
Found watched(double factor, std::uint64_t seed, const sim::GnssErrorModel& receiver = kRtk,
              double heading_off_rad = 0.0) {
  static const auto truth = sim::true_increments(winding(), kImuRateHz, kDurationS);
  ImuErrorModel sensor = automotive_mems_model();
  sensor.gyro.bias_sigma = 0.0;  // else no heading is known for long
  scale(sensor.accelerometer, factor);
  scale(sensor.gyro, factor);
  const test::Recording log =
      test::record(winding(), truth, sensor, receiver, 1.0, 1.0, seed);
  EkfConfig config;
  config.imu.gyro.bias_sigma = 0.0;
  config.gnss_correlation_s = 0.0;
  const Estimate start = test::truth_estimate(winding(), 0.0);
  const InitialSigma sigma{
      .tilt_rad = 0.01, .heading_rad = 0.02, .velocity_mps = 0.1, .position_m = 0.1};
  const ErrorMatrix P = initial_covariance(start, sigma, config.imu);
  Estimate drawn = test::drawn_start(start, P, seed);
  ErrorVector turn = ErrorVector::Zero();
  turn.segment<3>(kPsi) = heading_off_rad * down_e_at(start.nav.r_e_m);
  inject(drawn, turn);
  Ekf filter(config, drawn, P);
  CoastMonitor monitor;
  double first_alarm_s = std::numeric_limits<double>::infinity();
  auto fix = log.fixes.begin();
  for (const ImuIncrement& inc : log.imu) {
    filter.predict(inc);
    monitor.push(inc);
    if (fix == log.fixes.end() || fix->time != inc.time) continue;
    filter.update(*fix++);
    filter.scale_imu_noise(monitor.imu_sigma_scale());
    if (!monitor.compare(filter)) continue;
    first_alarm_s = std::min(first_alarm_s, to_seconds(inc.time));
  }
  return {monitor.imu_sigma_scale(), first_alarm_s};
}

/// Geometric mean over seeds 1 to kRuns.
double mean_learned(double factor) {
  double sum = 0.0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    sum += std::log(watched(factor, seed).imu_sigma_scale);
  }
  return std::exp(sum / kRuns);
}

TEST_CASE("an IMU that goes without fixes shows how good it is: as the model says, worse, better") {
  // 60 squares a run scatter the factor by 9 %, five runs by 4 %. The rest is what the filter's
  // biases, which it has learned with another factor, leave.
  CHECK(mean_learned(1.0) == doctest::Approx(1.0).epsilon(0.15));
  const double worse = mean_learned(3.0);
  CHECK(worse > 3.0 / 1.3);
  CHECK(worse < 3.0 * 1.3);
  const double better = mean_learned(0.5);
  CHECK(better > 0.5 / 1.3);
  CHECK(better < 0.5 * 1.5);
}

TEST_CASE("a heading that fixes turn by more than it claims is told, a right one is not") {
  int told = 0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    CAPTURE(seed);
    // 5 runs have 300 windows: a false alarm in one of 300 such tests.
    CHECK(watched(1.0, seed, kCode).first_alarm_s > kDurationS);
    if (watched(1.0, seed, kCode, 25.0 * kRadPerDeg).first_alarm_s < kPeriodS) ++told;
  }
  // By 20 sigma: the gate lets such fixes pass. Where it does not, the heading is not turned.
  CHECK(told >= kRuns - 1);
}

TEST_CASE("a copy that was forgotten, and one that has not coasted for long, say nothing") {
  const sim::Trajectory& way = winding();
  const EkfConfig config;
  const Estimate start = test::truth_estimate(way, 0.0);
  const Ekf filter(config, start, initial_covariance(start, {}, config.imu));
  CoastMonitor monitor;
  monitor.compare(filter);
  monitor.compare(filter);
  monitor.restart();
  ImuIncrement inc = sim::true_increments(way, kImuRateHz, 1.0).front();
  monitor.push(inc);
  CHECK(monitor.imu_sigma_scale() == 1.0);
}

}  // namespace
}  // namespace leeway
