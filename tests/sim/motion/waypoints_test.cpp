#include "leeway/sim/motion/waypoints.hpp"

#include <doctest/doctest.h>

#include <GeographicLib/Geodesic.hpp>
#include <GeographicLib/GeodesicLine.hpp>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/strapdown/strapdown.hpp"
#include "tests/sim/motion/central_difference.hpp"
#include "tests/support/near.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway::sim {
namespace {

using test::contains;
using test::near;

Geodetic at(double lat_deg, double lon_deg, double height_m) {
  return {lat_deg * kRadPerDeg, lon_deg * kRadPerDeg, height_m};
}

/// A block in a town: stops, right and left turns, a hill.
WaypointParameters town() {
  WaypointParameters p;
  p.waypoints = {{at(48.0, 11.0, 500.0), 12.0, 5.0},
                 {at(48.002, 11.0, 502.0), 8.0, {}},
                 {at(48.002, 11.004, 510.0), 14.0, 4.0},
                 {at(48.005, 11.004, 510.0), 10.0, {}},
                 {at(48.005, 10.998, 505.0), 10.0, 0.0}};
  p.acceleration_mps2 = 2.0;
  p.lateral_acceleration_mps2 = 2.5;
  p.turn_radius_m = 12.0;
  return p;
}

/// Paris to Rome by two fixes, 1100 km.
WaypointParameters flight() {
  WaypointParameters p;
  p.waypoints = {{at(49.0, 2.5, 100.0), 150.0, {}},
                 {at(48.0, 4.0, 9000.0), 240.0, {}},
                 {at(45.0, 9.0, 11000.0), 250.0, {}},
                 {at(41.8, 12.2, 1000.0), 100.0, {}}};
  p.acceleration_mps2 = 1.0;
  p.lateral_acceleration_mps2 = 4.0;
  p.banks = true;
  return p;
}

/// The town and the way back to its start.
WaypointParameters round_town(std::optional<double> duration_s = {}) {
  WaypointParameters p = town();
  p.waypoints.push_back({at(48.0, 10.998, 505.0), 9.0, {}});
  p.loop = true;
  p.duration_s = duration_s;
  return p;
}

std::vector<WaypointParameters> routes() {
  WaypointParameters at_pole;
  at_pole.waypoints = {{at(89.0, 10.0, 3000.0), 200.0, {}}, {at(89.0, -170.0, 3000.0), 200.0, {}}};
  WaypointParameters antimeridian;
  antimeridian.waypoints = {{at(-10.0, 179.99, 0.0), 10.0, {}},
                            {at(-10.0, -179.99, 0.0), 10.0, {}},
                            {at(-10.05, -179.99, 0.0), 8.0, {}}};
  return {town(), flight(), round_town(400.0), at_pole, antimeridian};
}

Geodetic position(const Trajectory& trajectory, double t_s) {
  return geodetic_from_ecef(truth_at(trajectory, t_s).nav.r_e_m);
}

NavStateNed ned(const Trajectory& trajectory, double t_s) {
  return ned_from_nav_state(truth_at(trajectory, t_s).nav);
}

std::string refusal(const WaypointParameters& p) {
  return test::message_of<Error>([&p] { waypoint_trajectory(p); });
}

}  // namespace

TEST_CASE("waypoints: velocity, specific force and angular rate are derivatives of the motion") {
  for (const WaypointParameters& parameters : routes()) {
    const Trajectory trajectory = waypoint_trajectory(parameters);
    const double step_s = trajectory.duration_s / 311.0;
    for (double t_s = 0.2; t_s < trajectory.duration_s - 0.2; t_s += step_s) {
      if (!is_smooth_at(trajectory, t_s)) continue;
      CAPTURE(parameters.waypoints.front().position.lat_rad);
      CAPTURE(t_s);
      const TruthPoint truth = truth_at(trajectory, t_s);
      const auto r = [&](double t) { return truth_at(trajectory, t).nav.r_e_m; };
      const auto v = [&](double t) { return truth_at(trajectory, t).nav.v_e_mps; };
      const auto turn = [&](double h) -> Eigen::Vector3d {
        const Eigen::Quaterniond before = truth_at(trajectory, t_s - h).nav.q_eb;
        return log_quaternion(before.conjugate() * truth_at(trajectory, t_s + h).nav.q_eb);
      };
      // Rounding of 2e-9 m over 5 ms, of 2e-13 m/s over 2 ms and of 4e-16 rad over 2 ms; the fifth
      // derivatives cost less.
      CHECK(near(truth.nav.v_e_mps, rate_of(r, t_s, 5e-3), 2e-6));
      const Eigen::Vector3d a_e_mps2 = truth.nav.q_eb * truth.f_ib_b_mps2 -
                                       2.0 * earth_rotation_e_radps().cross(truth.nav.v_e_mps) +
                                       gravity_e<GravityModel::kNormal>(truth.nav.r_e_m);
      CHECK(near(rate_of(v, t_s, 2e-3), a_e_mps2, 2e-9));
      const Eigen::Vector3d omega_eb_b =
          truth.omega_ib_b_radps -
          truth.nav.q_eb.toRotationMatrix().transpose() * earth_rotation_e_radps();
      CHECK(near(omega_eb_b, (8.0 * turn(1e-3) - turn(2e-3)) / 0.012, 2e-9));
    }
  }
}

TEST_CASE("waypoints: nothing jumps at the breaks but higher derivatives") {
  for (const WaypointParameters& parameters : routes()) {
    const Trajectory trajectory = waypoint_trajectory(parameters);
    CHECK(std::is_sorted(trajectory.breaks_s.begin(), trajectory.breaks_s.end()));
    for (const double break_s : trajectory.breaks_s) {
      CAPTURE(break_s);
      const double h_s = 1e-6;
      const TruthPoint before = truth_at(trajectory, break_s - h_s);
      const TruthPoint after = truth_at(trajectory, break_s + h_s);
      // 250 m/s, 5 m/s^2, 1 rad/s, 20 m/s^3 and 2 rad/s^2 over 2 us.
      CHECK(near(before.nav.r_e_m, after.nav.r_e_m, 5.1e-4));
      CHECK(near(before.nav.v_e_mps, after.nav.v_e_mps, 1e-5));
      CHECK(log_quaternion(before.nav.q_eb.conjugate() * after.nav.q_eb).norm() < 2e-6);
      CHECK(near(before.f_ib_b_mps2, after.f_ib_b_mps2, 4e-5));
      CHECK(near(before.omega_ib_b_radps, after.omega_ib_b_radps, 4e-6));
    }
  }
}

TEST_CASE("waypoints: true increments carry a strapdown along the route") {
  for (const WaypointParameters& parameters : {town(), flight()}) {
    const Trajectory trajectory = waypoint_trajectory(parameters);
    const double until_s = std::min(200.0, trajectory.duration_s);
    NavState state = truth_at(trajectory, 0.0).nav;
    ImuHistory history;
    const auto increments = true_increments(trajectory, 100.0, until_s);
    for (const ImuIncrement& inc : increments) {
      strapdown_step<Scheme::kRungeKutta4>(state, inc, history);
    }
    const NavState truth = truth_at(trajectory, to_seconds(increments.back().time)).nav;
    // As for the built-in trajectories: 20 000 steps rounded to 5e-10 m.
    CHECK(near(state.r_e_m, truth.r_e_m, 2e-5));
    CHECK(near(state.v_e_mps, truth.v_e_mps, 2e-8));
    CHECK(log_quaternion(truth.q_eb.conjugate() * state.q_eb).norm() < 1e-10);
  }
}

TEST_CASE("waypoints: a long leg is the geodesic, at its height above the ellipsoid") {
  WaypointParameters p;
  const Geodetic from = at(60.0, 5.0, 10000.0);
  const Geodetic to = at(20.0, 40.0, 10000.0);
  p.waypoints = {{from, 250.0, {}}, {to, 250.0, {}}};
  const Trajectory trajectory = waypoint_trajectory(p);
  const GeographicLib::GeodesicLine line =
      GeographicLib::Geodesic::WGS84().InverseLine(60.0, 5.0, 20.0, 40.0);
  for (const double fraction : {0.0, 0.1, 0.5, 0.73, 1.0}) {
    CAPTURE(fraction);
    const Geodetic here = position(trajectory, fraction * trajectory.duration_s);
    CHECK(near(here.height_m, 10000.0, 2e-8));  // rounding of geodetic_from_ecef
    double s12_m = 0.0, azimuth_deg = 0.0, lat_deg = 0.0, lon_deg = 0.0, ignored = 0.0;
    GeographicLib::Geodesic::WGS84().Inverse(60.0, 5.0, here.lat_rad / kRadPerDeg,
                                             here.lon_rad / kRadPerDeg, s12_m, azimuth_deg,
                                             ignored);
    line.Position(s12_m, lat_deg, lon_deg);
    // A great ellipse is as long as the geodesic to second order of the flattening, but leaves it
    // sideways to first order.
    double off_m = 0.0;
    GeographicLib::Geodesic::WGS84().Inverse(lat_deg, lon_deg, here.lat_rad / kRadPerDeg,
                                             here.lon_rad / kRadPerDeg, off_m);
    CHECK(off_m < 2e-4 * line.Distance());
  }
  const Geodetic end = position(trajectory, trajectory.duration_s);
  CHECK(near(end.lat_rad, to.lat_rad, 1e-14));
  CHECK(near(end.lon_rad, to.lon_rad, 1e-14));
  // The stated accuracy of speeds.
  CHECK(near(line.Distance() * (1.0 + 10000.0 / 6.37e6) / trajectory.duration_s, 250.0,
             0.5e-2 * 250.0));
}

TEST_CASE("waypoints: speeds, accelerations and stops are those asked for") {
  const WaypointParameters p = town();
  const Trajectory trajectory = waypoint_trajectory(p);
  double top_mps = 0.0, along_mps2 = 0.0, across_mps2 = 0.0, rest_s = 0.0;
  const double step_s = 0.01;
  for (double t_s = 0.0; t_s < trajectory.duration_s; t_s += step_s) {
    const TruthPoint truth = truth_at(trajectory, t_s);
    const NavStateNed here = ned_from_nav_state(truth.nav);
    const double ground_mps = here.v_n_mps.head<2>().norm();
    top_mps = std::max(top_mps, ground_mps);
    if (ground_mps < 1e-9) rest_s += step_s;
    // Level across the path: what pushes sideways and along is acceleration and slope.
    const double pitch_g = kStandardGravityMps2 * std::sin(here.attitude.pitch_rad);
    along_mps2 = std::max(along_mps2, std::abs(truth.f_ib_b_mps2.x() - pitch_g));
    across_mps2 = std::max(across_mps2, std::abs(truth.f_ib_b_mps2.y()));
    CHECK(near(here.attitude.roll_rad, 0.0, 1e-12));
    CHECK(here.position.height_m > 500.0 - 1e-6);
    CHECK(here.position.height_m < 510.0 + 1e-6);
    if (ground_mps < 0.1) continue;
    CHECK(near(wrap_pi(here.attitude.yaw_rad - std::atan2(here.v_n_mps.y(), here.v_n_mps.x())), 0.0,
               1e-9));
    CHECK(near(here.attitude.pitch_rad, std::atan2(-here.v_n_mps.z(), ground_mps), 1e-9));
  }
  CHECK(near(top_mps, 14.0, 0.002 * 14.0));
  CHECK(near(along_mps2, 2.0, 0.02));  // 0.2 %, and g is not 9.80665 here
  CHECK(near(across_mps2, 2.5, 0.02));
  CHECK(near(rest_s, 9.0, 0.05));
  CHECK(near(ned(trajectory, trajectory.duration_s).v_n_mps.norm(), 0.0, 1e-12));
}

TEST_CASE("waypoints: a turn keeps its radius, cuts the corner and banks") {
  WaypointParameters p = flight();
  p.turn_radius_m = 30e3;
  const Trajectory trajectory = waypoint_trajectory(p);
  double tightest_m = 1e9, sideways = 0.0, bank_rad = 0.0;
  for (double t_s = 0.0; t_s < trajectory.duration_s; t_s += 0.5) {
    const TruthPoint truth = truth_at(trajectory, t_s);
    const NavStateNed here = ned_from_nav_state(truth.nav);
    const double h_s = 0.01;
    const double later_s = std::min(t_s + h_s, trajectory.duration_s);
    const double yaw_rad = wrap_pi(ned(trajectory, later_s).attitude.yaw_rad -
                                   ned(trajectory, later_s - h_s).attitude.yaw_rad);
    const double speed_mps = here.v_n_mps.head<2>().norm();
    // The meridians converge: a straight path turns by v / R tan(lat).
    const double meridians = here.v_n_mps.y() / 6.39e6 * std::tan(here.position.lat_rad);
    tightest_m = std::min(tightest_m, speed_mps / std::abs(yaw_rad / h_s - meridians));
    sideways = std::max(sideways, std::abs(truth.f_ib_b_mps2.y()));
    bank_rad = std::max(bank_rad, std::abs(here.attitude.roll_rad));
  }
  CHECK(near(tightest_m, 30e3, 0.01 * 30e3));
  CHECK(near(bank_rad, std::atan(240.0 * 240.0 / 30e3 / 9.80665), 0.01));
  // Coriolis of 250 m/s, 0.027, and gravity at height that is 0.03 less than the bank supposes.
  CHECK(sideways < 0.04);
}

TEST_CASE("waypoints: a loop comes back to where it began, lap after lap") {
  const Trajectory lap = waypoint_trajectory(round_town());
  REQUIRE(lap.period_s.has_value());
  CHECK(*lap.period_s == lap.duration_s);
  const Trajectory laps = waypoint_trajectory(round_town(10.5 * lap.duration_s));
  CHECK(*laps.period_s == lap.duration_s);
  for (const double t_s : {0.0, 7.0, 50.0}) {
    CAPTURE(t_s);
    const TruthPoint first = truth_at(laps, t_s);
    const TruthPoint tenth = truth_at(laps, t_s + 9.0 * lap.duration_s);
    CHECK(near(first.nav.r_e_m, tenth.nav.r_e_m, 1e-8));
    CHECK(near(first.nav.v_e_mps, tenth.nav.v_e_mps, 1e-11));  // 1e-12 s of rounding
    CHECK(near(first.f_ib_b_mps2, tenth.f_ib_b_mps2, 1e-11));
  }
  const TruthPoint end = truth_at(lap, lap.duration_s - 1e-9);
  CHECK(near(end.nav.r_e_m, truth_at(lap, 0.0).nav.r_e_m, 1e-7));
}

TEST_CASE("waypoints: what cannot be travelled is refused, by waypoint") {
  const auto with = [](auto change) {
    WaypointParameters p = town();
    change(p);
    return refusal(p);
  };
  CHECK(contains(with([](auto& p) { p.waypoints.resize(1); }), "2 to 2000"));
  CHECK(contains(with([](auto& p) { p.waypoints[1].position = p.waypoints[0].position; }),
                 "waypoint 1: the next one is"));
  CHECK(contains(with([](auto& p) { p.waypoints[2].speed_mps = 0.0; }),
                 "waypoint 3: speed_mps is 0"));
  CHECK(contains(with([](auto& p) { p.turn_radius_m = 400.0; }), "lower the speed"));
  CHECK(contains(with([](auto& p) { p.waypoints[2].position.height_m = 900.0; }), "45 deg"));
  CHECK(contains(with([](auto& p) { p.waypoints[2].position = at(48.0001, 11.0, 502.0); }),
                 "waypoint 2: the path turns by 180 deg"));
  CHECK(contains(with([](auto& p) { p.duration_s = 1e5; }), "make the route a loop"));
  CHECK(contains(with([](auto& p) { p.acceleration_mps2 = -1.0; }), "acceleration_mps2 is -1"));
  CHECK(contains(with([](auto& p) { p.waypoints[3].position.lat_rad = std::nan(""); }),
                 "waypoint 4: latitude"));
  CHECK(contains(with([](auto& p) { p.waypoints[4].position = at(-48.0, -169.0, 0.0); }),
                 "waypoint 5: distance from the first"));
}

}  // namespace leeway::sim
