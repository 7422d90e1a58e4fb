#include "leeway/monitors/course_monitor.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/tools/random.hpp"

namespace leeway {
namespace {

constexpr Geodetic kPlace{0.8, 0.1, 300.0};
constexpr double kVelocitySigmaMps = 0.1;
constexpr double kAxleToAntennaM = 2.0;
constexpr double kSureRad = 1.0 * kRadPerDeg;

/// A level vehicle at the time of a fix, and what its filter believes.
struct Moment {
  double t_s{0.0};
  double heading_rad{0.0};
  double speed_mps{15.0};
  double turn_radps{0.0};
  double crab_rad{0.0};           ///< course of the rear axle minus heading
  double heading_error_rad{0.0};  ///< the filter's heading minus the true one
  double heading_sigma_rad{kSureRad};
};

/// The turn has lasted for no more than one increment, whose mean rate is the filter's.
Ekf filter_at(const Moment& m) {
  constexpr double kStepS = 1e-4;  // 0.5 rad/s turn the heading by 5e-5 rad
  const Eigen::Matrix3d C_en = ned_to_ecef(kPlace);
  Estimate estimate;
  estimate.nav.time = time_from_seconds(m.t_s - kStepS);
  estimate.nav.r_e_m = ecef_from_geodetic(kPlace);
  estimate.nav.q_eb = Eigen::Quaterniond(
      C_en * rotation_from_euler({0.0, 0.0, m.heading_rad + m.heading_error_rad}));
  const InitialSigma sigma{.tilt_rad = 0.01,
                           .heading_rad = m.heading_sigma_rad,
                           .velocity_mps = 0.1,
                           .position_m = 1.0};
  Ekf filter(EkfConfig{}, estimate, initial_covariance(estimate, sigma, EkfConfig{}.imu));
  ImuIncrement inc;
  inc.time = time_from_seconds(m.t_s);
  inc.dt_s = kStepS;
  inc.dtheta_b_rad.z() = m.turn_radps * kStepS;
  filter.predict(inc);
  return filter;
}

/// The antenna is ahead of the axle, and goes sideways in a turn.
GnssFix fix_at(const Moment& m, sim::Random& random) {
  const double course_rad = m.heading_rad + m.crab_rad;
  const double swing_mps = kAxleToAntennaM * m.turn_radps;
  Eigen::Vector3d v_n_mps(m.speed_mps * std::cos(course_rad) - swing_mps * std::sin(course_rad),
                          m.speed_mps * std::sin(course_rad) + swing_mps * std::cos(course_rad),
                          0.0);
  v_n_mps += kVelocitySigmaMps * random.normal3();
  GnssFix fix{time_from_seconds(m.t_s)};
  const double variance_m2ps2 = kVelocitySigmaMps * kVelocitySigmaMps;
  fix.velocity =
      GnssVelocity::from_ned(kPlace, v_n_mps, variance_m2ps2 * Eigen::Matrix3d::Identity());
  return fix;
}

bool alarms(CourseMonitor& monitor, const Moment& m, sim::Random& random) {
  return monitor.push(fix_at(m, random), filter_at(m));
}

TEST_CASE("a right heading is never called wrong: velocity noise, turns, a crab angle") {
  // 10 drives of 20 minutes are 12,000 fixes, of the 22,000 to a false alarm by Lorden's bound; and
  // the variance also has in it the heading's, whose error is zero here.
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed);
    CourseMonitor monitor(0.1, 0.0);  // of which the crab angle is one sigma
    Moment m{.crab_rad = 0.1};
    for (int k = 0; k < 1200; ++k) {
      m.t_s = k;
      const bool turns = k % 30 < 3;  // by 90 deg, every half a minute
      m.speed_mps = turns ? 6.0 : 15.0 + 9.0 * std::sin(0.05 * k);
      m.turn_radps = turns ? 0.5 : 0.0;  // the antenna goes 1 m/s sideways: by 0.17 rad
      m.heading_rad += m.turn_radps;
      REQUIRE_FALSE(alarms(monitor, m, random));
    }
    // It was learned: without it the vehicle no longer goes as it did. The difference is 0.1 rad or
    // a little more, from the turns. The noise at 15 m/s, the heading and the slip on a straight
    // leave it a sigma of 0.02 rad: a NIS of 25, the cap, and 8.7 nats a fix of the 10 asked for.
    // Noise may cost one fix.
    m = Moment{.t_s = 1200.0, .heading_rad = m.heading_rad};
    int fixes = 0;
    for (bool told = false; !told && fixes < 10; ++fixes, m.t_s += 1.0) {
      told = alarms(monitor, m, random);
    }
    CHECK(fixes <= 3);
  }
}

TEST_CASE("a heading that drifts by 0.5 deg/s is told within 20 s") {
  // The offset follows by at most 1/60 per second, so after t <= 20 s the difference has changed by
  // at least 60 (1 - exp(-t / 60)) 0.5 deg >= 0.417 t deg. Its sigma is at most that before any
  // fix: 0.05 rad, 1 deg of heading and 0.1 m/s at 15 m/s make 3.06 deg. Of fixes with a NIS of
  // 0.0186 t^2 those from t = 10 s on count in favour, by 0.5 (0.75 NIS - ln 4). Their sum is 10.4
  // after 20 s, and 10 is asked. What was learned before the drift makes the sigma smaller.
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed);
    CourseMonitor monitor(0.05, 0.0);
    Moment m;
    for (; m.t_s < 120.0; m.t_s += 1.0) REQUIRE_FALSE(alarms(monitor, m, random));
    double told_s = 0.0;
    for (double t_s = 1.0; told_s == 0.0 && t_s <= 60.0; t_s += 1.0, m.t_s += 1.0) {
      m.heading_error_rad = 0.5 * kRadPerDeg * t_s;
      if (alarms(monitor, m, random)) told_s = t_s;
    }
    CHECK(told_s > 0.0);
    CHECK(told_s <= 20.0);
  }
}

TEST_CASE("at less than 5 m/s the course says nothing: a car may be backing") {
  sim::Random random(1);
  CourseMonitor monitor(0.05, 0.0);
  Moment m{.speed_mps = 4.0, .crab_rad = 180.0 * kRadPerDeg};  // 10 sigma below 5 m/s
  for (; m.t_s < 1000.0; m.t_s += 1.0) REQUIRE_FALSE(alarms(monitor, m, random));
  m.speed_mps = 6.0;
  CHECK_FALSE(alarms(monitor, m, random));  // one fix alone is no reason to doubt
  m.t_s += 1.0;
  CHECK(alarms(monitor, m, random));  // each adds 0.5 (0.75 * 25 - ln 4) = 8.7, and 10 is asked
}

TEST_CASE("a heading that is unsure by 15 deg, and wanders, teaches no offset") {
  // With 0.05 rad for the offset it learns 0.035 / 60 of the difference per second: in 100 s no
  // more than 0.015 rad of 15 deg. That is less than the 1 deg of the heading that is then sure, so
  // the NIS stays below 1. Learned in full, the offset would be 0.2 rad.
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed);
    CourseMonitor monitor(0.05, 0.0);
    Moment m{.heading_sigma_rad = 15.0 * kRadPerDeg};
    for (; m.t_s < 100.0; m.t_s += 1.0) {
      m.heading_error_rad = 15.0 * kRadPerDeg * std::sin(90.0 * kRadPerDeg * m.t_s / 100.0);
      REQUIRE_FALSE(alarms(monitor, m, random));
    }
    m.heading_error_rad = 0.0;
    m.heading_sigma_rad = kSureRad;
    for (; m.t_s < 400.0; m.t_s += 1.0) REQUIRE_FALSE(alarms(monitor, m, random));
  }
}

}  // namespace
}  // namespace leeway
