#include "leeway/monitors/clock_monitor.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "leeway/model/initial_covariance.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/local_trajectory.hpp"

namespace leeway {
namespace {

constexpr double kClockImuHz = 50.0;
constexpr double kTurnsS = 120.0;
const sim::GnssErrorModel kClockCode{{1.5, 1.5, 2.0}, {0.1, 0.1, 0.1}};

/// Bends of 3 m/s^2 to the left and to the right, at 10 to 18 m/s.
const sim::Trajectory& bends() {
  static const sim::Trajectory trajectory = test::local_trajectory(300.0, [](double t_s) {
    const sim::Jet t = sim::time_jet(t_s);
    sim::LocalMotion m;
    m.north_m = 75.0 * sin(0.2 * t);
    m.east_m = 10.0 * t;
    m.yaw_rad = atan2(10.0 + 0.0 * t, 15.0 * cos(0.2 * t));
    return m;
  });
  return trajectory;
}

/// The fix of a receiver whose clock is ahead: it is older than its stamp.
GnssFix late(const sim::Trajectory& way, GnssFix fix, double position_s, double velocity_s) {
  const double t_s = to_seconds(fix.time);
  const NavState now = sim::truth_at(way, t_s).nav;
  fix.position->r_e_m += sim::truth_at(way, std::max(0.0, t_s - position_s)).nav.r_e_m - now.r_e_m;
  fix.velocity->v_e_mps +=
      sim::truth_at(way, std::max(0.0, t_s - velocity_s)).nav.v_e_mps - now.v_e_mps;
  return fix;
}

struct Watch {
  sim::Trajectory way{bends()};
  double position_s{0.0};
  double velocity_s{0.0};
  double from_s{0.0};  ///< when fixes begin to be late
  double duration_s{kTurnsS};
  sim::GnssErrorModel gnss{kClockCode};

  /// Beside a filter that begins at the truth, as far as it claims.
  /// @param observe  after each fix
  ClockOffset operator()(std::uint64_t seed,
                         const std::function<void(const ClockOffset&, double t_s)>& observe = {}) {
    const auto truth = sim::true_increments(way, kClockImuHz, duration_s);
    const ImuErrorModel imu = automotive_mems_model();
    const test::Recording log = test::record(way, truth, imu, gnss, 1.0, 1.0, seed);
    EkfConfig config;
    config.gnss_correlation_s = 0.0;  // as these errors are
    const Estimate start = test::truth_estimate(way, 0.0);
    const ErrorMatrix P = initial_covariance(
        start, {.tilt_rad = 0.01, .heading_rad = 0.05, .velocity_mps = 0.1, .position_m = 1.0},
        config.imu);
    Ekf filter(config, test::drawn_start(start, P, seed), P);
    ClockMonitor monitor(config.gnss_correlation_s);
    auto next = log.fixes.begin();
    for (const ImuIncrement& inc : log.imu) {
      filter.predict(inc);
      monitor.push(inc, filter);
      if (next == log.fixes.end() || next->time != inc.time) continue;
      const double t_s = to_seconds(inc.time);
      const GnssFix fix = t_s < from_s ? *next : late(way, *next, position_s, velocity_s);
      ++next;
      monitor.reach(filter);
      const UpdateOutcome outcome = filter.update(fix);
      monitor.take(fix, outcome, {}, filter, true);
      if (observe) observe(monitor.offset(), t_s);
    }
    return monitor.offset();
  }
};

TEST_CASE("50 ms between the clocks are detected within two minutes of turns") {
  // One sigma is then 6 ms or less: 50 ms are eight, and five are asked for.
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const double offset_s : {0.05, -0.05}) {
      CAPTURE(seed);
      CAPTURE(offset_s);
      const ClockOffset found = Watch{.position_s = offset_s, .velocity_s = offset_s}(seed);
      CHECK(found.beyond_chance);
      CHECK(found.sigma_s < 0.009);
      // Four sigmas: one of 16,000 such tests fails by chance.
      CHECK(std::abs(found.value_s - offset_s) < 4.0 * found.sigma_s);
      CHECK_FALSE(found.of_velocity);
    }
  }
}

TEST_CASE("right clocks are never called wrong, in 200 trials" * doctest::test_suite("heavy")) {
  double square_sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    CAPTURE(seed);
    const ClockOffset found = Watch{}(
        seed, [](const ClockOffset& offset, double) { REQUIRE_FALSE(offset.beyond_chance); });
    square_sum += std::pow(found.value_s / found.sigma_s, 2);
  }
  // 200 squares of a Gaussian have a mean within 0.7 and 1.35 in 99.9 % of cases; the sigma is
  // that of a filter which also allows for errors of the IMU in the turns, and is modest.
  CHECK(square_sum / 200.0 > 0.5);
  CHECK(square_sum / 200.0 < 1.35);
}

TEST_CASE("what is asked of the filter is what it does: the errors by an offset, by differences") {
  // The position lags by v dt, the velocity by a dt in part. U is compared where the filter has
  // forgotten its start.
  const double offset_s = 0.05;
  const auto truth = sim::true_increments(bends(), kClockImuHz, kTurnsS);
  sim::GnssErrorModel quiet{{0.5, 0.5, 0.5}, {0.1, 0.1, 0.1}};
  const test::Recording log =
      test::record(bends(), truth, automotive_mems_model(), quiet, 1.0, 1.0, 1);
  EkfConfig config;
  config.gnss_correlation_s = 0.0;
  const Estimate start = test::truth_estimate(bends(), 0.0);
  const ErrorMatrix P = initial_covariance(start, {}, config.imu);
  Ekf right(config, start, P);
  Ekf other(config, start, P);
  ClockMonitor monitor(0.0);
  auto next = log.fixes.begin();
  ErrorVector square_sum = ErrorVector::Zero();
  ErrorVector difference_sum = ErrorVector::Zero();
  for (const ImuIncrement& inc : log.imu) {
    right.predict(inc);
    other.predict(inc);
    monitor.push(inc, right);
    if (next == log.fixes.end() || next->time != inc.time) continue;
    monitor.reach(right);
    const UpdateOutcome outcome = right.update(*next);
    monitor.take(*next, outcome, {}, right, true);
    other.update(late(bends(), *next, offset_s, offset_s));
    ++next;
    if (to_seconds(inc.time) < 60.0) continue;
    const ErrorVector by_difference = difference(right.estimate(), other.estimate()) / offset_s;
    const ErrorVector by_monitor = monitor.sensitivity_per_s();
    square_sum += by_difference.cwiseAbs2();
    difference_sum += (by_difference - by_monitor).cwiseAbs2();
  }
  // 5 % of steps of 0.1 s, 10 % of what is of second order in the offset.
  const auto ratio = [&](int first) {
    return std::sqrt(difference_sum.segment<3>(first).sum() / square_sum.segment<3>(first).sum());
  };
  CHECK(ratio(kDr) < 0.1);
  CHECK(ratio(kDv) < 0.15);
  CHECK(ratio(kPsi) < 0.3);
}

TEST_CASE("on a straight at constant speed nothing shows, and nothing is claimed") {
  Watch watch{.way = sim::straight({.duration_s = kTurnsS}), .position_s = 0.2, .velocity_s = 0.2};
  const ClockOffset found = watch(1);
  CHECK_FALSE(found.beyond_chance);
  CHECK(found.sigma_s > 0.2);
}

TEST_CASE("velocities that are late alone are told from clocks") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    CAPTURE(seed);
    const ClockOffset found = Watch{.velocity_s = 0.3}(seed);
    CHECK(found.beyond_chance);
    CHECK(found.of_velocity);
    CHECK(found.value_s == doctest::Approx(0.3).epsilon(0.15));  // four sigmas of 0.01 s
  }
}

TEST_CASE("a step of one second, as a leap second is, is found within a minute") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const double step_s : {1.0, -1.0}) {
      CAPTURE(seed);
      CAPTURE(step_s);
      double found_s = -1.0;
      Watch watch{.position_s = step_s, .velocity_s = step_s, .from_s = 60.0, .duration_s = 180.0};
      watch(seed, [&](const ClockOffset& offset, double t_s) {
        if (found_s < 0.0 && offset.beyond_chance) found_s = t_s;
        if (t_s < 60.0) REQUIRE_FALSE(offset.beyond_chance);
        // A first answer by changes of velocity is of first order: a second is long for that.
        if (t_s > 120.0) CHECK(offset.value_s == doctest::Approx(step_s).epsilon(0.35));
      });
      CHECK(found_s > 60.0);
      CHECK(found_s < 120.0);
    }
  }
}

}  // namespace
}  // namespace leeway
