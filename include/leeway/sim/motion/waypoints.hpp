/// @file
/// A drive, flight or voyage through waypoints, of any length: it follows the ellipsoid.
#pragma once

#include <optional>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

/// A place on a route, and how the vehicle leaves it.
struct Waypoint {
  Geodetic position{};
  /// Ground speed from here to the next waypoint, > 0. At the last waypoint of an open route it is
  /// the speed at its end.
  double speed_mps{};
  std::optional<double> stop_s{};  ///< duration of a stop here; absent: no stop
};

/// Parameters of a route through waypoints.
struct WaypointParameters {
  std::vector<Waypoint> waypoints{};      ///< 2 to 2000 waypoints
  bool loop{false};                       ///< from the last waypoint back to the first, repeatedly
  double acceleration_mps2{1.0};          ///< greatest along the path, > 0
  double lateral_acceleration_mps2{2.0};  ///< greatest in a turn, > 0
  std::optional<double> turn_radius_m{};  ///< least; absent: from lateral acceleration and speed
  bool banks{false};                      ///< rolls into turns, so that no force acts sideways
  std::optional<double> duration_s{};     ///< absent: time of the whole route, one lap of a loop
};

/// Arcs of great ellipses from waypoint to waypoint, at heights above the ellipsoid that change by
/// smooth steps between turns. A corner is rounded on the inside, over the turn radius and at least
/// one second (three when banking), so the path does not touch a waypoint where it turns. The
/// vehicle goes as fast as speeds and accelerations allow, and stops where the turn of a corner
/// begins. The body points along the path, level across it or banked.
///
/// Height is exact to rounding. Speeds, radii and lateral accelerations are within 0.2 % near the
/// latitude and height of the first waypoint, and within 0.5 % anywhere. Position, velocity,
/// attitude and angular rate are continuous; at breaks_s higher derivatives jump. Angles are given
/// to first order: their second derivatives are zero.
/// @throws Error naming the waypoint or the field and the allowed range. Also when an open route is
/// shorter than duration_s, or goes further than 7000 km from its start.
Trajectory waypoint_trajectory(const WaypointParameters& parameters);

}  // namespace leeway::sim
