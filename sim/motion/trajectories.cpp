#include "leeway/sim/motion/trajectories.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "lib/earth/field_walk.hpp"

namespace leeway::sim {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kTwoPi = 2.0 * std::numbers::pi;
Trajectory make(const char* name, const Geodetic& origin, double duration_s) {
  require(name, "origin.lat_rad", origin.lat_rad, kFinite);
  require(name, "origin.lon_rad", origin.lon_rad, kFinite);
  require(name, "origin.height_m", origin.height_m, kFinite);
  require(name, "duration_s", duration_s, kPositive);
  Trajectory trajectory;
  trajectory.name = name;
  trajectory.plane = TangentPlane(origin);
  trajectory.duration_s = duration_s;
  return trajectory;
}

LocalMotion circle_motion(const CircleParameters& p, double t_s) {
  LocalMotion m;
  m.yaw_rad = time_jet(t_s) * (p.speed_mps / p.radius_m);
  m.north_m = p.radius_m * sin(m.yaw_rad);
  m.east_m = p.radius_m * (1.0 - cos(m.yaw_rad));
  return m;
}

LocalMotion square_loop_motion(const SquareLoopParameters& p, double t_s) {
  const double quarter_turn_rad = 0.5 * kPi;
  const double straight_m = p.speed_mps * p.straight_s;
  const double radius_m = p.speed_mps * p.turn_s / quarter_turn_rad;
  const double side_s = p.straight_s + p.turn_s;
  const double sides = std::floor(t_s / side_s);
  const Jet phase_s = time_jet(t_s) - sides * side_s;

  // Along the side's direction and right of it, from where the side starts.
  Jet along_m = p.speed_mps * phase_s;
  Jet right_m = 0.0;
  Jet turned_rad = 0.0;
  if (phase_s.value >= p.straight_s) {
    turned_rad = (phase_s - p.straight_s) * (quarter_turn_rad / p.turn_s);
    along_m = straight_m + radius_m * sin(turned_rad);
    right_m = radius_m * (1.0 - cos(turned_rad));
  }

  // Four sides and no sum over the sides so far: nothing accumulates.
  struct Side {
    double start_north_m, start_east_m, north, east;
  };
  const std::array<Side, 4> table{{{0.0, 0.0, 1.0, 0.0},
                                   {straight_m + radius_m, radius_m, 0.0, 1.0},
                                   {straight_m, straight_m + 2.0 * radius_m, -1.0, 0.0},
                                   {-radius_m, straight_m + radius_m, 0.0, -1.0}}};
  const double quarter = sides - 4.0 * std::floor(sides / 4.0);
  const Side& side = table[static_cast<std::size_t>(quarter)];
  LocalMotion m;
  m.north_m = side.start_north_m + side.north * along_m - side.east * right_m;
  m.east_m = side.start_east_m + side.east * along_m + side.north * right_m;
  m.yaw_rad = quarter * quarter_turn_rad + turned_rad;
  return m;
}

/// One start and stop of the car: how fast the path parameter runs between them, and for how long.
struct DriveLeg {
  double rate_radps;
  double ramp_s;
  double hold_s;
  double rest_s;

  constexpr double duration_s() const { return 2.0 * ramp_s + hold_s + rest_s; }
  constexpr double travel_rad() const { return rate_radps * (ramp_s + hold_s); }
};

// The first is a town at low speed, the second and third open road, the fourth a short hop.
constexpr std::array<DriveLeg, 4> kLegs{{{0.025, 10.0, 70.0, 12.0},
                                         {0.042, 20.0, 160.0, 20.0},
                                         {0.036, 18.0, 95.0, 15.0},
                                         {0.020, 9.0, 20.0, 10.0}}};

/// Path travelled since a start that is eased by a half cosine of rate.
Jet eased_start(const Jet& since_s, const DriveLeg& leg) {
  return 0.5 * leg.rate_radps * (since_s - leg.ramp_s / kPi * sin(since_s * (kPi / leg.ramp_s)));
}

Jet leg_travel(const Jet& since_s, const DriveLeg& leg) {
  const double brake_s = leg.ramp_s + leg.hold_s;
  if (since_s.value < leg.ramp_s) return eased_start(since_s, leg);
  if (since_s.value < brake_s) return leg.rate_radps * (since_s - 0.5 * leg.ramp_s);
  if (since_s.value < brake_s + leg.ramp_s) {
    return leg.travel_rad() - eased_start(brake_s + leg.ramp_s - since_s, leg);
  }
  return leg.travel_rad();
}

/// The path parameter of the drive: smooth and never falling, exactly constant at the stops.
Jet path_parameter(double driving_s) {
  if (driving_s < 0.0) return 0.0;
  double cycle_s = 0.0;
  double cycle_rad = 0.0;
  for (const DriveLeg& leg : kLegs) {
    cycle_s += leg.duration_s();
    cycle_rad += leg.travel_rad();
  }
  const double cycles = std::floor(driving_s / cycle_s);
  Jet left_s = time_jet(driving_s) - cycles * cycle_s;
  double travelled_rad = cycles * cycle_rad;
  for (const DriveLeg& leg : kLegs) {
    if (left_s.value < leg.duration_s()) return travelled_rad + leg_travel(left_s, leg);
    left_s = left_s - leg.duration_s();
    travelled_rad += leg.travel_rad();
  }
  return travelled_rad;
}

std::vector<double> car_drive_breaks(const CarDriveParameters& p) {
  std::vector<double> breaks_s;
  double t_s = p.initial_rest_s;
  for (std::size_t i = 0; t_s < p.duration_s; ++i) {
    const DriveLeg& leg = kLegs[i % kLegs.size()];
    for (const double part_s : {leg.ramp_s, leg.hold_s, leg.ramp_s, leg.rest_s}) {
      if (t_s > 0.0 && t_s < p.duration_s) breaks_s.push_back(t_s);
      t_s += part_s;
    }
  }
  return breaks_s;
}

/// The road as a closed curve of the parameter u; the tangent is written out because its
/// derivatives give the turn rates. It crosses itself at u = 0 and pi, at one height.
LocalMotion car_drive_motion(const CarDriveParameters& p, double t_s) {
  const Jet u = path_parameter(t_s - p.initial_rest_s);
  LocalMotion m;
  m.north_m = 540.0 * sin(u);
  m.east_m = 90.0 * sin(2.0 * u) + 9.0 * sin(6.0 * u);
  m.down_m = -12.0 * sin(u) - 6.0 * (1.0 - cos(2.0 * u));
  const Jet north = 540.0 * cos(u);
  const Jet east = 180.0 * cos(2.0 * u) + 54.0 * cos(6.0 * u);
  const Jet down = -12.0 * cos(u) - 12.0 * sin(2.0 * u);
  const Jet bumps_pitch = 0.4 * kRadPerDeg * (sin(131.0 * u) - sin(47.0 * u));
  const Jet bumps_roll = 0.5 * kRadPerDeg * sin(171.0 * u);
  const Jet camber = 1.5 * kRadPerDeg * sin(9.0 * u);
  m.yaw_rad = atan2(east, north);
  m.pitch_rad = atan2(-down, sqrt(north * north + east * east)) + bumps_pitch;
  m.roll_rad = camber + bumps_roll;
  return m;
}

}  // namespace

Trajectory static_trajectory(const StaticParameters& parameters) {
  Trajectory trajectory = make("static", parameters.origin, parameters.duration_s);
  LocalMotion m;
  m.roll_rad = parameters.attitude.roll_rad;
  m.pitch_rad = parameters.attitude.pitch_rad;
  m.yaw_rad = parameters.attitude.yaw_rad;
  require("static", "attitude.roll_rad", m.roll_rad.value, kFinite);
  require("static", "attitude.pitch_rad", m.pitch_rad.value, kFinite);
  require("static", "attitude.yaw_rad", m.yaw_rad.value, kFinite);
  trajectory.motion = [m](double) { return m; };
  trajectory.period_s = 60.0;  // any would do
  return trajectory;
}

Trajectory straight(const StraightParameters& p) {
  Trajectory trajectory = make("straight", p.origin, p.duration_s);
  require("straight", "ground_speed_mps", p.ground_speed_mps, kNotNegative);
  require("straight", "climb_rate_mps", p.climb_rate_mps, kFinite);
  require("straight", "heading_rad", p.heading_rad, kFinite);
  trajectory.motion = [p](double t_s) {
    const Jet t = time_jet(t_s);
    LocalMotion m;
    m.north_m = p.ground_speed_mps * std::cos(p.heading_rad) * t;
    m.east_m = p.ground_speed_mps * std::sin(p.heading_rad) * t;
    m.down_m = -p.climb_rate_mps * t;
    m.pitch_rad = std::atan2(p.climb_rate_mps, p.ground_speed_mps);
    m.yaw_rad = p.heading_rad;
    return m;
  };
  return trajectory;
}

Trajectory circle(const CircleParameters& p) {
  Trajectory trajectory = make("circle", p.origin, p.duration_s);
  require("circle", "radius_m", p.radius_m, kPositive);
  require("circle", "speed_mps", p.speed_mps, kNotNegative);
  trajectory.motion = [p](double t_s) { return circle_motion(p, t_s); };
  if (p.speed_mps > 0.0) trajectory.period_s = kTwoPi * p.radius_m / p.speed_mps;
  return trajectory;
}

Trajectory square_loop(const SquareLoopParameters& p) {
  Trajectory trajectory = make("square loop", p.origin, p.duration_s);
  require("square loop", "speed_mps", p.speed_mps, kNotNegative);
  require("square loop", "straight_s", p.straight_s, kNotNegative);
  require("square loop", "turn_s", p.turn_s, kPositive);
  trajectory.motion = [p](double t_s) { return square_loop_motion(p, t_s); };
  const double side_s = p.straight_s + p.turn_s;
  trajectory.period_s = 4.0 * side_s;
  for (double k = 0.0; k * side_s < p.duration_s; ++k) {
    if (k > 0.0) trajectory.breaks_s.push_back(k * side_s);
    const double turn_start_s = k * side_s + p.straight_s;
    if (turn_start_s < p.duration_s) trajectory.breaks_s.push_back(turn_start_s);
  }
  return trajectory;
}

Trajectory car_drive(const CarDriveParameters& p) {
  Trajectory trajectory = make("car drive", p.origin, p.duration_s);
  require("car drive", "initial_rest_s", p.initial_rest_s, kNotNegative);
  trajectory.motion = [p](double t_s) { return car_drive_motion(p, t_s); };
  trajectory.breaks_s = car_drive_breaks(p);
  return trajectory;
}

Trajectory circle20() {
  Trajectory trajectory = circle({.duration_s = 60.0});
  trajectory.name = "circle20";
  return trajectory;
}

Trajectory manoeuvre_car() {
  Trajectory trajectory =
      make("manoeuvre_car", {56.0 * kRadPerDeg, 92.8 * kRadPerDeg, 150.0}, 100.0);
  trajectory.motion = [](double t_s) {
    const Jet t = time_jet(t_s);
    const double w = kTwoPi / 120.0;
    LocalMotion m;
    m.north_m = 400.0 * sin(w * t);
    m.east_m = 200.0 * sin(2.0 * w * t);
    m.down_m = -0.02 * sin(kTwoPi * 1.1 * t);
    m.roll_rad = 3.0 * kRadPerDeg * sin(kTwoPi * 1.3 * t);
    m.pitch_rad = 2.0 * kRadPerDeg * sin(kTwoPi * 1.7 * t + 0.4);
    m.yaw_rad = atan2(400.0 * w * cos(2.0 * w * t), 400.0 * w * cos(w * t));
    return m;
  };
  return trajectory;
}

}  // namespace leeway::sim
