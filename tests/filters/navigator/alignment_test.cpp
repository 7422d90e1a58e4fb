#include "leeway/navigator/alignment.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/model/claimed_solution.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/local_trajectory.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

using test::near;

/// Feeds a log until it aligns.
std::optional<Alignment> align(Aligner& aligner, const test::Recording& log) {
  std::size_t next = 0;
  for (const ImuIncrement& inc : log.imu) {
    aligner.push(inc);
    if (next == log.fixes.size() || log.fixes[next].time != inc.time) continue;
    if (auto result = aligner.push(log.fixes[next++])) return result;
  }
  return std::nullopt;
}

sim::GnssErrorModel almost_perfect_gnss() {
  sim::GnssErrorModel gnss;
  gnss.position_sigma_n_m.setConstant(1e-6);
  gnss.velocity_sigma_n_mps.setConstant(1e-6);
  return gnss;
}

/// Attitude error of an alignment in roll, pitch, yaw.
Eigen::Vector3d attitude_error_rad(const Alignment& alignment, const sim::Trajectory& trajectory) {
  const NavState truth = sim::truth_at(trajectory, to_seconds(alignment.estimate.nav.time)).nav;
  const EulerAngles a = ned_from_nav_state(alignment.estimate.nav).attitude;
  const EulerAngles b = ned_from_nav_state(truth).attitude;
  return {wrap_pi(a.roll_rad - b.roll_rad), a.pitch_rad - b.pitch_rad,
          wrap_pi(a.yaw_rad - b.yaw_rad)};
}

}  // namespace

TEST_CASE("level undoes any roll and pitch, at rest and while accelerating") {
  const double g = kStandardGravityMps2;
  for (const Eigen::Vector3d& f_level :
       {Eigen::Vector3d(0, 0, -g), Eigen::Vector3d(3, 0, -g), Eigen::Vector3d(-5, 2, -g),
        Eigen::Vector3d(0.5, -4, -1.2 * g)}) {
    for (double roll_deg = -175.0; roll_deg <= 180.0; roll_deg += 35.5) {
      // Beyond this the force comes from behind, and pitch and roll + 180 deg look alike.
      for (const double pitch_deg : {-55.0, -20.0, 0.0, 1e-6, 33.0, 55.0}) {
        CAPTURE(f_level.x());
        CAPTURE(roll_deg);
        CAPTURE(pitch_deg);
        const EulerAngles truth{roll_deg * kRadPerDeg, pitch_deg * kRadPerDeg, 0.0};
        const Eigen::Vector3d f_b = rotation_from_euler(truth).transpose() * f_level;
        const EulerAngles found = level(f_b, f_level);
        CHECK(near(wrap_pi(found.roll_rad - truth.roll_rad), 0.0, 1e-14));
        CHECK(near(found.pitch_rad, truth.pitch_rad, 1e-14));
        CHECK(found.yaw_rad == 0.0);
      }
    }
  }
}

TEST_CASE("static levelling by a biased accelerometer errs by bias over gravity") {
  const EulerAngles attitude{0.1, -0.2, 1.0};
  const sim::Trajectory rest = sim::static_trajectory({.attitude = attitude, .duration_s = 10.0});
  const ImuIncrement sum = sim::true_increment(rest, 0.0, 10.0);
  const Eigen::Vector3d level_f(0.0, 0.0, -9.81);
  const EulerAngles exact = level(sum.dv_b_mps / 10.0, level_f);
  CHECK(near(exact.roll_rad, 0.1,
             1e-6));  // gravity is known to 1e-3 m/s^2, but its direction is not touched
  CHECK(near(exact.pitch_rad, -0.2, 1e-6));
  const Eigen::Vector3d biased = sum.dv_b_mps / 10.0 + Eigen::Vector3d(0.05, 0.0, 0.0);
  // A forward bias reads as a nose that is higher by b cos(pitch) / g.
  CHECK(near(level(biased, level_f).pitch_rad + 0.2, 0.05 * std::cos(0.2) / 9.81, 3e-5));
}

TEST_CASE("aligned in a straight, in a turn, while braking and on a hill") {
  struct Case {
    std::string name;
    sim::Trajectory trajectory;
    double tolerance_rad;
  };
  const sim::Trajectory braking = test::local_trajectory(20.0, [](double t_s) {
    sim::LocalMotion m;
    const sim::Jet t = sim::time_jet(t_s);
    m.east_m = 25.0 * t - 1.5 * t * t;
    m.yaw_rad = 90.0 * kRadPerDeg;
    return m;
  });
  const sim::Trajectory hill = test::local_trajectory(20.0, [](double t_s) {
    sim::LocalMotion m;
    const sim::Jet t = sim::time_jet(t_s);
    m.north_m = -20.0 * std::cos(0.06) * t;
    m.down_m = -20.0 * std::sin(0.06) * t;
    m.pitch_rad = 0.06;
    m.roll_rad = -0.03;
    m.yaw_rad = 180.0 * kRadPerDeg;
    return m;
  });
  // Coriolis, 2e-3 m/s^2 at 20 m/s, is left out: 2.2e-4 rad. In the turn also the mean of force and
  // course over a second, and what the lever arm adds to the course, tell on 4 m/s^2.
  const Case cases[] = {{"straight", sim::straight({.heading_rad = 2.0}), 3e-4},
                        {"turn", sim::circle({.radius_m = 100.0, .speed_mps = 20.0}), 3e-3},
                        {"braking", braking, 3e-4},
                        {"hill", hill, 3e-4}};
  for (const Case& c : cases) {
    CAPTURE(c.name);
    EkfConfig filter;
    filter.lever_arm_b_m = {1.0, 0.5, -1.2};
    sim::GnssErrorModel gnss = almost_perfect_gnss();
    gnss.lever_arm_b_m = filter.lever_arm_b_m;
    const auto log = test::record(c.trajectory, sim::true_increments(c.trajectory, 100.0, 5.0), {},
                                  gnss, 1.0, 1.0, 1);
    Aligner aligner({}, filter);
    const auto result = align(aligner, log);
    REQUIRE(result);
    CHECK(result->estimate.nav.time == time_from_seconds(2.0));  // two fixes are enough
    const Eigen::Vector3d error = attitude_error_rad(*result, c.trajectory);
    CAPTURE(error.transpose());
    // A lever arm ahead of the axle sees a course of w l / v = 0.01 rad more in the turn.
    CHECK(near(error.head<2>(), Eigen::Vector2d::Zero(), c.tolerance_rad));
    CHECK(near(error.z(), 0.0, c.tolerance_rad + 0.012 * (&c == &cases[1])));
    const Estimate truth = test::truth_estimate(c.trajectory, 2.0);
    // The antenna is taken back to the IMU: over an arm of 1.6 m, by the attitude just found.
    CHECK(near(result->estimate.nav.r_e_m, truth.nav.r_e_m, 0.02));
    CHECK(near(result->estimate.nav.v_e_mps, truth.nav.v_e_mps, 0.01));
  }
}

TEST_CASE("never before the minimum speed, nor without position, nor across a hole") {
  const auto run = [](double speed_mps, double interval_s, bool with_position) {
    const sim::Trajectory trajectory = sim::straight({.ground_speed_mps = speed_mps});
    auto log = test::record(trajectory, sim::true_increments(trajectory, 50.0, 30.0), {},
                            almost_perfect_gnss(), interval_s, interval_s, 1);
    for (GnssFix& fix : log.fixes) {
      if (!with_position) fix.position.reset();
    }
    Aligner aligner({}, {});
    return align(aligner, log).has_value();
  };
  CHECK(run(3.1, 1.0, true));
  CHECK_FALSE(run(2.9, 1.0, true));
  CHECK_FALSE(run(0.0, 1.0, true));
  CHECK_FALSE(run(10.0, 1.0, false));
  CHECK(run(10.0, 2.4, true));
  CHECK(run(10.0, 15.0, true));
}

TEST_CASE("five minutes at a standstill with unknown heading, then a drive: seeds 1 to 20" *
          doctest::test_suite("heavy")) {
  const sim::Trajectory drive = sim::car_drive({.initial_rest_s = 300.0, .duration_s = 360.0});
  const auto truth = sim::true_increments(drive, 50.0, 360.0);
  const EkfConfig filter;
  double heading_sq = 0.0;
  double gyro_sq = 0.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const auto log = test::record(drive, truth, filter.imu, {}, 1.0, 1.0, seed);
    Aligner aligner({}, filter);
    const auto result = align(aligner, log);
    REQUIRE(result);
    const double t_s = to_seconds(result->estimate.nav.time);
    CHECK(t_s > 300.0);
    CHECK(t_s < 320.0);
    const Solution s = solution(result->estimate, result->P);
    const Eigen::Vector3d error =
        attitude_error_rad(*result, drive).cwiseQuotient(s.sigma_attitude_rad);
    CHECK(error.cwiseAbs().maxCoeff() < 3.0);
    heading_sq += error.z() * error.z() / 20.0;
    // The bias at the end of the log, 40 s later: 0.02 deg/s of drift over 300 s is in the sigma.
    const Eigen::Vector3d gyro =
        (log.bias.b_g_radps - result->estimate.bias.b_g_radps).cwiseQuotient(s.sigma_b_g_radps);
    CHECK(gyro.cwiseAbs().maxCoeff() < 4.0);
    gyro_sq += gyro.squaredNorm() / 60.0;
    CHECK(s.sigma_b_g_radps.maxCoeff() < 0.1 * filter.imu.gyro.bias_sigma);
  }
  MESSAGE("RMS over sigma: heading " << std::sqrt(heading_sq) << ", gyro bias "
                                     << std::sqrt(gyro_sq));
  // Heading sigma holds 0.05 rad for sideslip, which this car has not; the rest is honest.
  CHECK(std::sqrt(heading_sq) > 0.1);
  CHECK(std::sqrt(heading_sq) < 1.2);
  CHECK(std::sqrt(gyro_sq) > 0.5);
  CHECK(std::sqrt(gyro_sq) < 1.5);
}

TEST_CASE("a short rest gives no gyro bias") {
  const sim::Trajectory drive = sim::car_drive({.initial_rest_s = 2.0, .duration_s = 40.0});
  const EkfConfig filter;
  const auto log =
      test::record(drive, sim::true_increments(drive, 50.0, 40.0), filter.imu, {}, 1.0, 1.0, 1);
  Aligner aligner({}, filter);
  const auto result = align(aligner, log);
  REQUIRE(result);
  CHECK(result->estimate.bias.b_g_radps.isZero(0.0));
  CHECK(near(std::sqrt(result->P(kBg, kBg)) / filter.imu.gyro.bias_sigma, 1.0, 1e-2));
}

TEST_CASE("an invalid configuration is refused: the field, its value, its range") {
  struct Case {
    const char* field;
    double AlignmentConfig::*member;
  };
  for (const Case& c : {Case{"min_speed_mps", &AlignmentConfig::min_speed_mps},
                        Case{"sideslip_rad", &AlignmentConfig::sideslip_rad},
                        Case{"tilt_floor_rad", &AlignmentConfig::tilt_floor_rad},
                        Case{"max_fix_interval_s", &AlignmentConfig::max_fix_interval_s},
                        Case{"rest_speed_mps", &AlignmentConfig::rest_speed_mps},
                        Case{"rest_turn_rad", &AlignmentConfig::rest_turn_rad},
                        Case{"min_rest_s", &AlignmentConfig::min_rest_s}}) {
    for (const auto& [value, text] : {std::pair{0.0, "is 0"}, std::pair{-2.0, "is -2"}}) {
      AlignmentConfig config;
      config.*c.member = value;
      const std::string message = test::message_of<Error>([&] { Aligner(config, EkfConfig{}); });
      CAPTURE(message);
      CHECK(test::contains(message, c.field));
      CHECK(test::contains(message, text));
      CHECK(test::contains(message, "> 0"));
    }
  }
}

}  // namespace leeway
