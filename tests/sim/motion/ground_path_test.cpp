#include "leeway/sim/motion/ground_path.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "leeway/model/error_metric.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {

using test::near;

TEST_CASE("way and course of a straight line and of a circle") {
  const GroundPath line(straight({.heading_rad = 1.0}), 600.0);
  CHECK(near(line.distance_m(0.0, 600.0), 12000.0, 1e-6));
  CHECK(near(line.distance_m(100.3, 101.4), 22.0, 1e-6));
  CHECK(line.distance_m(50.0, 50.0) == 0.0);
  CHECK(near(line.course_rad(0.0), 1.0, 1e-9));
  const Trajectory round = circle();
  const GroundPath circle_path(round, 600.0);
  CHECK(near(circle_path.distance_m(0.0, 600.0), 12000.0, 1e-6));
  // By the motion's own velocity: exact, wherever between the pieces.
  for (const double t_s : {0.0, 3.21, 17.7, 31.4, 300.1}) {
    CAPTURE(t_s);
    CHECK(
        near(circle_path.course_rad(t_s), course_over_ground_rad(truth_at(round, t_s).nav), 1e-12));
  }
}

TEST_CASE("a loop is as long after laps as it is after one, lap by lap") {
  const Trajectory loop = square_loop();
  const double lap_s = *loop.period_s;
  const GroundPath path(loop, 10.0 * lap_s);
  const double lap_m = path.distance_m(0.0, lap_s);
  CHECK(near(lap_m, 20.0 * lap_s, 1e-3 * lap_m));
  CHECK(near(path.distance_m(0.25 * lap_s, 7.75 * lap_s), 7.5 * lap_m, 1e-6 * lap_m));
  CHECK(near(path.distance_m(0.0, 10.0 * lap_s), 10.0 * lap_m, 1e-6));
}

TEST_CASE("where a vehicle stands its course is the last it had, before any motion its heading") {
  const GroundPath still(static_trajectory({.attitude = {.yaw_rad = 2.0}}), 100.0);
  CHECK(near(still.course_rad(50.0), 2.0, 1e-12));
  CHECK(still.distance_m(0.0, 100.0) == 0.0);
  const Trajectory drive = car_drive();
  const GroundPath path(drive, drive.duration_s);
  const double heading_rad = course_over_ground_rad(truth_at(drive, 0.0).nav);
  CHECK(path.course_rad(1.0) == heading_rad);
  double moving_rad = heading_rad;
  int stands = 0;
  for (double t_s = 0.0; t_s < 600.0; t_s += 0.25) {
    CAPTURE(t_s);
    const NavState now = truth_at(drive, t_s).nav;
    if (now.v_e_mps.norm() >= kStandingMps) {
      moving_rad = course_over_ground_rad(now);
      CHECK(near(path.course_rad(t_s), moving_rad, 1e-12));
    } else {
      ++stands;
      // A stop is straight: no turn is lost in the half second of a piece.
      CHECK(near(std::remainder(path.course_rad(t_s) - moving_rad, 2.0 * std::numbers::pi), 0.0,
                 0.02));
    }
  }
  CHECK(stands > 40);
}

}  // namespace leeway::sim
