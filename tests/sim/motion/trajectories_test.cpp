#include "leeway/sim/motion/trajectories.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "leeway/earth/error.hpp"
#include "tests/support/near.hpp"
#include "tests/support/numbers.hpp"

namespace leeway::sim {
namespace {

using test::near;

using test::kNan;

Eigen::Vector3d position_l(const LocalMotion& m) {
  return {m.north_m.value, m.east_m.value, m.down_m.value};
}

Eigen::Vector3d velocity_l(const LocalMotion& m) {
  return {m.north_m.first, m.east_m.first, m.down_m.first};
}

Eigen::Vector3d acceleration_l(const LocalMotion& m) {
  return {m.north_m.second, m.east_m.second, m.down_m.second};
}

}  // namespace

TEST_CASE("straight: the stated velocity, the body along it") {
  const Trajectory trajectory = straight(
      {.ground_speed_mps = 30.0, .climb_rate_mps = 3.0, .heading_rad = std::numbers::pi / 6.0});
  const LocalMotion m = trajectory.motion(100.0);
  // One rounding of 2600 m.
  CHECK(near(position_l(m), Eigen::Vector3d(1500.0 * std::sqrt(3.0), 1500.0, -300.0), 1e-12));
  CHECK(near(velocity_l(m), Eigen::Vector3d(15.0 * std::sqrt(3.0), 15.0, -3.0), 1e-14));
  CHECK(near(std::tan(m.pitch_rad.value), 0.1, 1e-16));
  CHECK(m.yaw_rad.value == std::numbers::pi / 6.0);
}

TEST_CASE("circle: radius about the centre, speed, and the body along the path") {
  const Trajectory trajectory = circle({.radius_m = 50.0, .speed_mps = 10.0});
  for (double t_s = 0.0; t_s < 60.0; t_s += 3.7) {
    const LocalMotion m = trajectory.motion(t_s);
    CHECK(near((position_l(m) - Eigen::Vector3d(0.0, 50.0, 0.0)).norm(), 50.0, 1e-13));
    CHECK(near(velocity_l(m).norm(), 10.0, 1e-14));
    CHECK(near(acceleration_l(m).norm(), 2.0, 1e-14));
    const Eigen::Vector3d forward(std::cos(m.yaw_rad.value), std::sin(m.yaw_rad.value), 0.0);
    CHECK(near(forward, velocity_l(m) / 10.0, 1e-15));
  }
}

TEST_CASE("square loop: agrees with dead reckoning from its yaw rate") {
  const Trajectory trajectory = square_loop();
  const double step_s = 0.01;
  double north_m = 0.0;
  double east_m = 0.0;
  double yaw_rad = 0.0;
  for (int k = 0; k < 50'000; ++k) {
    const bool turns = (k / 1000) % 6 == 5;  // the last 10 s of every 60 s
    const double turn_rad = turns ? 9.0 * kRadPerDeg * step_s : 0.0;
    north_m += 20.0 * step_s * std::cos(yaw_rad + 0.5 * turn_rad);
    east_m += 20.0 * step_s * std::sin(yaw_rad + 0.5 * turn_rad);
    yaw_rad += turn_rad;
    if (k % 100 != 99) continue;
    const double t_s = step_s * (k + 1);
    CAPTURE(t_s);
    const LocalMotion m = trajectory.motion(t_s);
    // The midpoint rule errs by (turn per step)^2 / 24 of the length of the turns, 1600 m: 2e-4 m.
    REQUIRE(near(position_l(m), Eigen::Vector3d(north_m, east_m, 0.0), 3e-4));
    REQUIRE(near(std::remainder(m.yaw_rad.value - yaw_rad, 2.0 * std::numbers::pi), 0.0, 1e-10));
    REQUIRE(near(velocity_l(m).norm(), 20.0, 1e-13));
  }
}

TEST_CASE("square loop: four sides close exactly, after four hours too") {
  const Trajectory trajectory = square_loop();
  for (const double loop_s : {240.0, 14160.0}) {
    for (const double t_s : {0.0, 17.0, 53.5, 110.25, 239.0}) {
      CAPTURE(loop_s);
      CAPTURE(t_s);
      const LocalMotion first = trajectory.motion(t_s);
      const LocalMotion later = trajectory.motion(t_s + loop_s);
      // The phase is exact for these times.
      CHECK(position_l(first) == position_l(later));
      CHECK(first.yaw_rad.value == later.yaw_rad.value);
    }
  }
}

TEST_CASE("square loop: breaks are where straights and turns meet, and only they are") {
  const Trajectory trajectory = square_loop({.duration_s = 175.0});
  CHECK(trajectory.breaks_s == std::vector<double>{50.0, 60.0, 110.0, 120.0, 170.0});
  const double h_s = 1e-6;
  for (const double break_s : trajectory.breaks_s) {
    CAPTURE(break_s);
    const LocalMotion before = trajectory.motion(break_s - h_s);
    const LocalMotion after = trajectory.motion(break_s + h_s);
    CHECK(near(position_l(before), position_l(after), 41.0 * h_s));  // 20 m/s over 2 h
    CHECK(near(velocity_l(before), velocity_l(after), 6.4 * h_s));   // pi m/s^2 over 2 h
    CHECK(near((acceleration_l(after) - acceleration_l(before)).norm(), std::numbers::pi, 1e-5));
    CHECK(near(std::abs(after.yaw_rad.first - before.yaw_rad.first), 9.0 * kRadPerDeg, 1e-12));
  }
}

TEST_CASE("car drive: rests, speeds, accelerations and slopes are those of a car") {
  const Trajectory trajectory = car_drive({.duration_s = 3600.0});
  double top_speed = 0.0, along = 0.0, across = 0.0, slope = 0.0, roll = 0.0, pitch = 0.0;
  for (double t_s = 0.0; t_s < 3600.0; t_s += 0.05) {
    const LocalMotion m = trajectory.motion(t_s);
    const Eigen::Vector3d v = velocity_l(m);
    roll = std::max(roll, std::abs(m.roll_rad.value));
    pitch = std::max(pitch, std::abs(m.pitch_rad.value));
    if (v.norm() < 0.01) continue;
    const double ground = std::hypot(v.x(), v.y());
    const Eigen::Vector3d right(-v.y() / ground, v.x() / ground, 0.0);
    top_speed = std::max(top_speed, v.norm());
    along = std::max(along, std::abs(acceleration_l(m).dot(v)) / v.norm());
    across = std::max(across, std::abs(acceleration_l(m).dot(right)));
    slope = std::max(slope, std::abs(v.z()) / ground);
    // The body points along the road; bumps are 0.8 deg at most.
    CHECK(near(m.pitch_rad.value, std::atan2(-v.z(), ground), 0.81 * kRadPerDeg));
    CHECK(near(std::remainder(m.yaw_rad.value - std::atan2(v.y(), v.x()), 2 * std::numbers::pi),
               0.0, 1e-9));
  }
  CHECK(top_speed > 20.0);
  CHECK(top_speed < 25.0);
  CHECK(along > 1.0);
  CHECK(along < 2.5);
  CHECK(across > 1.0);
  CHECK(across < 3.5);
  CHECK(slope > 0.04);
  CHECK(slope < 0.065);
  CHECK(roll > 1.0 * kRadPerDeg);
  CHECK(roll < 3.0 * kRadPerDeg);
  CHECK(pitch > 2.0 * kRadPerDeg);
  CHECK(pitch < 5.0 * kRadPerDeg);
}

TEST_CASE("car drive: at rest first, then stops of 10 to 20 s with nothing moving at all") {
  const Trajectory trajectory = car_drive();
  const double step_s = 0.1;
  double rest_s = 0.0;
  int stops = 0;
  for (int k = 0; k < 18'000; ++k) {
    const double t_s = step_s * k;
    CAPTURE(t_s);
    const LocalMotion m = trajectory.motion(t_s);
    const bool at_rest = velocity_l(m).norm() == 0.0;
    if (t_s < 30.0) REQUIRE(at_rest);
    if (at_rest) {
      CHECK(acceleration_l(m).norm() == 0.0);
      CHECK(m.yaw_rad.first == 0.0);
      CHECK(m.pitch_rad.first == 0.0);
      CHECK(m.roll_rad.first == 0.0);
      rest_s += step_s;
    } else {
      if (rest_s > 1.0 && t_s > 31.0) {
        ++stops;
        CHECK(rest_s > 9.5);
        CHECK(rest_s < 20.5);
      }
      rest_s = 0.0;
    }
  }
  CHECK(stops >= 10);
}

TEST_CASE("car drive: acceleration and turn rate are continuous, at the breaks as elsewhere") {
  const Trajectory trajectory = car_drive({.initial_rest_s = 10.0, .duration_s = 900.0});
  REQUIRE(trajectory.breaks_s.size() > 20);
  CHECK(std::is_sorted(trajectory.breaks_s.begin(), trajectory.breaks_s.end()));
  CHECK(trajectory.breaks_s.front() == 10.0);
  const double h_s = 1e-7;
  for (const double break_s : trajectory.breaks_s) {
    CAPTURE(break_s);
    const LocalMotion before = trajectory.motion(break_s - h_s);
    const LocalMotion after = trajectory.motion(break_s + h_s);
    CHECK(near(position_l(before), position_l(after), 60.0 * h_s));
    CHECK(near(velocity_l(before), velocity_l(after), 6.0 * h_s));
    CHECK(near(acceleration_l(before), acceleration_l(after), 6.0 * h_s));
    CHECK(near(before.yaw_rad.first, after.yaw_rad.first, 6.0 * h_s));
  }
}

TEST_CASE("car drive: the road is closed and crosses itself at one height") {
  const Trajectory trajectory = car_drive({.duration_s = 7200.0});
  double farthest_m = 0.0;
  int crossings = 0;
  for (double t_s = 0.0; t_s < 7200.0; t_s += 0.05) {
    const Eigen::Vector3d r = position_l(trajectory.motion(t_s));
    farthest_m = std::max(farthest_m, r.norm());
    if (std::hypot(r.x(), r.y()) > 1.0) continue;
    ++crossings;
    CHECK(near(r.z(), 0.0, 0.1));  // a slope of 6 % over 1 m
  }
  CHECK(crossings > 40);
  CHECK(farthest_m < 600.0);
}

TEST_CASE("parameters outside their range are refused by name") {
  CHECK_THROWS_WITH_AS(circle({.radius_m = 0.0}), "circle: radius_m is 0, must be finite and > 0",
                       Error);
  CHECK_THROWS_WITH_AS(circle({.speed_mps = -1.0}),
                       "circle: speed_mps is -1, must be finite and >= 0", Error);
  CHECK_THROWS_AS(circle({.duration_s = 0.0}), Error);
  CHECK_THROWS_AS(static_trajectory({.origin = {kNan, 0.0, 0.0}}), Error);
  CHECK_THROWS_AS(static_trajectory({.attitude = {0.0, kNan, 0.0}}), Error);
  CHECK_THROWS_WITH_AS(straight({.heading_rad = kNan}),
                       "straight: heading_rad is nan, must be finite", Error);
  CHECK_THROWS_AS(square_loop({.turn_s = 0.0}), Error);
  CHECK_THROWS_AS(square_loop({.straight_s = -1.0}), Error);
  CHECK_THROWS_AS(car_drive({.initial_rest_s = -1.0}), Error);
  CHECK_THROWS_AS(car_drive({.duration_s = std::numeric_limits<double>::infinity()}), Error);
}

}  // namespace leeway::sim
