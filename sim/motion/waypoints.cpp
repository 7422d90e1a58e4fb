#include "leeway/sim/motion/waypoints.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "lib/earth/field_walk.hpp"
#include "sim/motion/ellipsoid_path.hpp"
#include "sim/motion/speed_profile.hpp"

namespace leeway::sim {
namespace {

constexpr double kMostWaypoints = 2000.0;
constexpr std::size_t kMostBreaks = 1'000'000;
constexpr double kFarthestWaypointM = 7e6;
constexpr double kSlowestMps = 0.01;
constexpr double kFastestMps = 1e4;

// A small corner would be turned in no time by its radius alone.
constexpr double kShortestTurnS = 1.0;
constexpr double kShortestBankedTurnS = 3.0;  // rolls in and out

void validate(const WaypointParameters& p) {
  require("waypoints", "their number", static_cast<double>(p.waypoints.size()),
          between(2.0, kMostWaypoints));
  require("waypoints", "acceleration_mps2", p.acceleration_mps2, between(1e-3, 1e3));
  require("waypoints", "lateral_acceleration_mps2", p.lateral_acceleration_mps2,
          between(1e-3, 1e3));
  if (p.turn_radius_m) require("waypoints", "turn_radius_m", *p.turn_radius_m, between(0.1, 1e6));
  if (p.duration_s) require("waypoints", "duration_s", *p.duration_s, between(1e-3, 1e7));
  const Eigen::Vector3d start_e_m = ecef_from_geodetic(p.waypoints.front().position);
  for (std::size_t k = 0; k < p.waypoints.size(); ++k) {
    const Waypoint& w = p.waypoints[k];
    const std::string name = "waypoint " + std::to_string(k + 1);
    const bool may_rest = k + 1 == p.waypoints.size() && !p.loop;
    require(name.c_str(), "latitude, deg,", w.position.lat_rad / kRadPerDeg, between(-90.0, 90.0));
    require(name.c_str(), "longitude, deg,", w.position.lon_rad / kRadPerDeg,
            between(-360.0, 360.0));
    require(name.c_str(), "height_m", w.position.height_m, between(-1.2e4, 1e5));
    require(name.c_str(), "speed_mps", w.speed_mps,
            between(may_rest ? 0.0 : kSlowestMps, kFastestMps));
    require(name.c_str(), "stop_s", w.stop_s.value_or(0.0), between(0.0, 1e6));
    require(name.c_str(), "distance from the first, m,",
            (ecef_from_geodetic(w.position) - start_e_m).norm(), between(0.0, kFarthestWaypointM));
  }
}

/// Path and time law of a route; shared by the copies of its trajectory.
class Route {
 public:
  explicit Route(const WaypointParameters& p)
      : corner_speeds_mps_(corner_speeds(p)),
        path_(corners(p), p.loop),
        profile_(nodes(p), p.acceleration_mps2, p.loop),
        banks_(p.banks) {}

  const SpeedProfile& profile() const { return profile_; }

  LocalMotion motion(const TangentPlane& plane, double t_s) const;

 private:
  /// The slower of the speeds before and after a corner, and no faster than its radius allows.
  static std::vector<double> corner_speeds(const WaypointParameters& p) {
    const std::size_t count = p.waypoints.size();
    std::vector<double> speeds_mps;
    for (std::size_t k = 0; k < count; ++k) {
      double speed_mps = p.waypoints[k].speed_mps;
      if (p.loop || k > 0) {
        speed_mps = std::min(speed_mps, p.waypoints[(k + count - 1) % count].speed_mps);
      }
      if (p.turn_radius_m) {
        speed_mps = std::min(speed_mps, std::sqrt(p.lateral_acceleration_mps2 * *p.turn_radius_m));
      }
      speeds_mps.push_back(speed_mps);
    }
    return speeds_mps;
  }

  std::vector<Corner> corners(const WaypointParameters& p) const {
    std::vector<Corner> corners;
    for (std::size_t k = 0; k < p.waypoints.size(); ++k) {
      const double v_mps = corner_speeds_mps_[k];
      corners.push_back({p.waypoints[k].position,
                         p.turn_radius_m.value_or(v_mps * v_mps / p.lateral_acceleration_mps2),
                         v_mps * (p.banks ? kShortestBankedTurnS : kShortestTurnS)});
    }
    return corners;
  }

  /// Two for each corner: where it begins to turn, which is where it stops, and where that ends.
  std::vector<SpeedNode> nodes(const WaypointParameters& p) const {
    const std::vector<TurnSpan>& turns = path_.turns();
    std::vector<SpeedNode> nodes;
    for (std::size_t k = 0; k < turns.size(); ++k) {
      const std::size_t corner = k % p.waypoints.size();
      const Waypoint& waypoint = p.waypoints[corner];
      const double v_mps = corner_speeds_mps_[corner];
      const bool turns_here = turns[k].end_m > turns[k].start_m;
      nodes.push_back({turns[k].start_m, waypoint.stop_s ? 0.0 : v_mps,
                       turns_here ? v_mps : waypoint.speed_mps, waypoint.stop_s.value_or(0.0)});
      if (p.loop && k + 1 == turns.size()) break;
      if (turns_here) nodes.push_back({turns[k].end_m, v_mps, waypoint.speed_mps, 0.0});
    }
    return nodes;
  }

  std::vector<double> corner_speeds_mps_;  // at which each corner is turned
  EllipsoidPath path_;
  SpeedProfile profile_;
  bool banks_;
};

/// f(s(t)) from f as a function of s.
Jet in_time(const Jet& f, const Jet& s) {
  return {f.value, f.first * s.first, f.second * s.first * s.first + f.first * s.second};
}

JetVector in_time(const JetVector& f, const Jet& s) {
  return {in_time(f.x, s), in_time(f.y, s), in_time(f.z, s)};
}

LocalMotion Route::motion(const TangentPlane& plane, double t_s) const {
  const Jet s_m = profile_.distance_m(t_s);
  const PathPoint point = path_.at(s_m.value);
  const Eigen::Matrix3d C_le = plane.C_el.transpose();
  const JetVector from_origin_e_m = in_time(point.position_e_m, s_m) - plane.origin_e_m;

  // The columns of C_lb as far as the Euler angles need them. The path's direction is not lost at a
  // stop, as the velocity's would be.
  const JetVector forward = C_le * in_time(normalized(derivative(point.position_e_m)), s_m);
  const JetVector right = normalized(cross(forward, C_le * in_time(point.up_e, s_m)));
  const JetVector down = cross(forward, right);
  Jet bank_rad = 0.0;
  if (banks_) {
    const Jet v_mps(s_m.first, s_m.second, 0.0);
    bank_rad = atan2(v_mps * v_mps * in_time(point.curvature_per_m, s_m), kStandardGravityMps2);
  }
  const Jet c = cos(bank_rad);
  const Jet s = sin(bank_rad);

  LocalMotion m;
  const JetVector r_l_m = C_le * from_origin_e_m;
  m.north_m = r_l_m.x;
  m.east_m = r_l_m.y;
  m.down_m = r_l_m.z;
  m.yaw_rad = atan2(forward.y, forward.x);
  m.pitch_rad = atan2(-forward.z, sqrt(forward.x * forward.x + forward.y * forward.y));
  m.roll_rad = atan2(c * right.z + s * down.z, c * down.z - s * right.z);
  return m;
}

/// Of all laps, within the duration.
std::vector<double> breaks_s(const SpeedProfile& profile, bool loop, double duration_s) {
  const std::vector<double> lap_s = profile.breaks_s();
  const double laps = loop ? std::ceil(duration_s / profile.duration_s()) : 1.0;
  if (laps * static_cast<double>(lap_s.size() + 1) > static_cast<double>(kMostBreaks)) {
    throw Error("waypoints: a lap of " + std::to_string(profile.duration_s()) +
                " s is repeated too often within " + std::to_string(duration_s) + " s");
  }
  std::vector<double> all_s;
  for (double lap = 0.0; lap < laps; ++lap) {
    const double start_s = lap * profile.duration_s();
    if (lap > 0.0 && start_s < duration_s) all_s.push_back(start_s);
    for (const double t_s : lap_s) {
      if (start_s + t_s < duration_s) all_s.push_back(start_s + t_s);
    }
  }
  return all_s;
}

}  // namespace

Trajectory waypoint_trajectory(const WaypointParameters& p) {
  validate(p);
  const auto route = std::make_shared<const Route>(p);
  const double route_s = route->profile().duration_s();
  const double duration_s = p.duration_s.value_or(route_s);
  if (!p.loop && duration_s > route_s) {
    throw Error("waypoints: duration_s is " + std::to_string(duration_s) + ", the route ends at " +
                std::to_string(route_s) + " s: shorten it, or make the route a loop");
  }
  Trajectory trajectory;
  trajectory.name = "waypoints";
  trajectory.plane = TangentPlane(p.waypoints.front().position);
  trajectory.duration_s = duration_s;
  trajectory.breaks_s = breaks_s(route->profile(), p.loop, duration_s);
  if (p.loop) trajectory.period_s = route_s;
  trajectory.motion = [route, plane = trajectory.plane, loop = p.loop, route_s](double t_s) {
    return route->motion(plane, loop ? std::fmod(t_s, route_s) : t_s);
  };
  return trajectory;
}

}  // namespace leeway::sim
