#include "sim/atlas/faults/regime.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "leeway/earth/earth.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/motion/waypoints.hpp"
#include "sim/motion/smooth_step.hpp"

namespace leeway::sim {
namespace {

constexpr double kLongestRunS = 600.0;

/// A level figure of eight with its first derivatives as jets: bodies follow them.
struct Eight {
  Jet u;
  Jet north_m, east_m;
  Jet north_mps, east_mps;
  Jet north_mps2, east_mps2;
};

/// @param half_m  from the crossing to an end; its speed there is half_m * rate_radps
Eight eight_at(double t_s, double half_m, double rate_radps) {
  const double speed_mps = half_m * rate_radps;
  Eight e;
  e.u = time_jet(t_s) * rate_radps;
  e.north_m = half_m * sin(e.u);
  e.east_m = 0.5 * half_m * sin(2.0 * e.u);
  e.north_mps = speed_mps * cos(e.u);
  e.east_mps = speed_mps * cos(2.0 * e.u);
  e.north_mps2 = -speed_mps * rate_radps * sin(e.u);
  e.east_mps2 = -2.0 * speed_mps * rate_radps * sin(2.0 * e.u);
  return e;
}

Trajectory trajectory_of(const char* name, std::function<LocalMotion(double t_s)> motion) {
  Trajectory trajectory;
  trajectory.name = name;
  trajectory.plane = TangentPlane(kDefaultOrigin);
  trajectory.duration_s = kLongestRunS;
  trajectory.motion = std::move(motion);
  return trajectory;
}

/// A swell, and a drift of 10 deg to the lee.
LocalMotion ship_motion(double t_s) {
  const Eight e = eight_at(t_s, 250.0, 0.03);
  const Jet t = time_jet(t_s);
  LocalMotion m;
  m.north_m = e.north_m + 0.4 * sin(0.7 * t);
  m.east_m = e.east_m + 0.4 * cos(0.6 * t);
  m.down_m = 0.5 * sin(0.8 * t);
  m.roll_rad = 5.0 * kRadPerDeg * sin(0.75 * t);
  m.pitch_rad = 2.0 * kRadPerDeg * sin(0.9 * t);
  m.yaw_rad = atan2(e.east_mps, e.north_mps) + 10.0 * kRadPerDeg + 0.03 * sin(0.5 * t);
  return m;
}

/// Leans into its accelerations; its nose turns slowly, wherever it flies.
LocalMotion multirotor_motion(double t_s) {
  const Eight e = eight_at(t_s, 40.0, 0.2);
  const Jet t = time_jet(t_s);
  const Jet yaw_rad = 0.05 * t;
  LocalMotion m;
  m.north_m = e.north_m;
  m.east_m = e.east_m;
  m.down_m = -20.0 + 3.0 * sin(0.15 * t);
  m.yaw_rad = yaw_rad;
  m.pitch_rad = (e.north_mps2 * cos(yaw_rad) + e.east_mps2 * sin(yaw_rad)) *
                (-1.0 / kStandardGravityMps2);
  m.roll_rad = (e.east_mps2 * cos(yaw_rad) - e.north_mps2 * sin(yaw_rad)) *
               (1.0 / kStandardGravityMps2);
  return m;
}

/// Two steps a second; the sensor is worn 40 deg off the way that is gone.
LocalMotion walker_motion(double t_s) {
  const Eight e = eight_at(t_s, 15.0, 0.09);
  const Jet steps = 2.0 * std::numbers::pi * 1.8 * time_jet(t_s);
  LocalMotion m;
  m.north_m = e.north_m;
  m.east_m = e.east_m;
  m.down_m = 0.02 * sin(steps);
  m.roll_rad = 2.0 * kRadPerDeg * sin(0.5 * steps);
  m.pitch_rad = 3.0 * kRadPerDeg * sin(steps);
  m.yaw_rad = atan2(e.east_mps, e.north_mps) + 40.0 * kRadPerDeg + 0.05 * sin(0.5 * steps);
  return m;
}

Trajectory car_trajectory() {
  return car_drive({.initial_rest_s = 10.0, .duration_s = kLongestRunS});
}

/// Four banked turns of 27 deg, 3 km apart, at 60 m/s, up and down by 200 m.
Trajectory aircraft_trajectory() {
  WaypointParameters p;
  constexpr double kSideLatRad = 3000.0 / 6.37e6;
  const double side_lon_rad = kSideLatRad / std::cos(kDefaultOrigin.lat_rad);
  for (const auto& [north, east] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    Geodetic at = kDefaultOrigin;
    at.lat_rad += north * kSideLatRad;
    at.lon_rad += east * side_lon_rad;
    at.height_m = 1000.0 + 200.0 * north;
    p.waypoints.push_back({.position = at, .speed_mps = 60.0});
  }
  p.loop = true;
  p.lateral_acceleration_mps2 = 5.0;
  p.banks = true;
  p.duration_s = kLongestRunS;
  return waypoint_trajectory(p);
}

Regime regime_of(const char* name, VehicleKind kind, Trajectory trajectory, double turns_at_s) {
  Regime regime{.name = name, .trajectory = std::move(trajectory), .gnss = code_receiver()};
  regime.config.vehicle = VehicleConfig::of(kind);
  regime.turns_at_s = turns_at_s;
  return regime;
}

std::vector<Regime> made_regimes() {
  const Trajectory car = car_trajectory();
  constexpr double kCarTurnS = 70.0;
  std::vector<Regime> all;
  all.push_back(regime_of("default", VehicleKind::kNone, car, kCarTurnS));
  all.push_back(regime_of("car", VehicleKind::kCar, car, kCarTurnS));
  all.push_back(all.back());
  all.back().name = "car RTK";
  all.back().gnss = rtk_receiver();
  all.push_back(regime_of("ship", VehicleKind::kBoat, trajectory_of("ship", ship_motion), 50.0));
  all.push_back(regime_of("multirotor", VehicleKind::kMultirotor,
                            trajectory_of("multirotor", multirotor_motion), 8.0));
  all.push_back(regime_of("aircraft", VehicleKind::kAircraft, aircraft_trajectory(), 40.0));
  // A walker that has not stood still is not levelled.
  const Trajectory walk = trajectory_of("walker", walker_motion);
  all.push_back(regime_of("walker", VehicleKind::kWalker, walk, 17.0));
  all.back().trajectory = paced_at_first(walk, 0.0, 0.0, 5.0);
  return all;
}

/// The chain rule.
Jet at_clock(const Jet& m, const Jet& s) {
  return {m.value, m.first * s.first, m.second * s.first * s.first + m.first * s.second};
}

}  // namespace

GnssErrorModel code_receiver() {
  GnssErrorModel gnss;
  gnss.position_sigma_n_m << 1.0, 1.0, 1.5;
  gnss.correlated_sigma_n_m << 2.0, 2.0, 3.0;
  gnss.correlation_time_s = 30.0;
  return gnss;
}

GnssErrorModel rtk_receiver() {
  GnssErrorModel gnss;
  gnss.position_sigma_n_m.setConstant(0.02);
  gnss.velocity_sigma_n_mps.setConstant(0.03);
  return gnss;
}

const std::vector<Regime>& regimes() {
  static const std::vector<Regime> kRegimes = made_regimes();
  return kRegimes;
}

Trajectory rescheduled(const Trajectory& trajectory, std::function<Jet(double t_s)> clock) {
  Trajectory result = trajectory;
  result.breaks_s.clear();
  result.motion = [way = trajectory.motion, clock = std::move(clock)](double t_s) {
    const Jet s = clock(t_s);
    LocalMotion m = way(s.value);
    for (Jet* jet : {&m.north_m, &m.east_m, &m.down_m, &m.roll_rad, &m.pitch_rad, &m.yaw_rad}) {
      *jet = at_clock(*jet, s);
    }
    return m;
  };
  return result;
}

Trajectory paced_at_first(const Trajectory& trajectory, double start_s, double pace,
                          double from_s) {
  constexpr double kChangeS = 10.0;
  return rescheduled(trajectory, [=](double t_s) -> Jet {
    const Jet t = time_jet(t_s);
    if (t_s < from_s) return start_s + pace * t;
    const double reached_s = start_s + pace * from_s;
    const Jet x = (t - from_s) * (1.0 / kChangeS);
    if (t_s < from_s + kChangeS) {
      return reached_s + pace * (t - from_s) +
             (1.0 - pace) * kChangeS * smooth_step_integral(x);
    }
    return reached_s + 0.5 * (1.0 + pace) * kChangeS + (t - from_s - kChangeS);
  });
}

}  // namespace leeway::sim
