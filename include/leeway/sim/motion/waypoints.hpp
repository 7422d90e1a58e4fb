/// @file
/// A drive, flight or voyage through waypoints, of any length: it follows the ellipsoid.
#pragma once

#include <optional>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

struct Waypoint {
  Geodetic position{};
  /// Ground speed on the way from here to the next waypoint, > 0. At the last waypoint of an open
  /// route the speed it ends with.
  double speed_mps{};
  std::optional<double> stop_s{};  ///< comes to rest here for so long; absent: passes
};

struct WaypointParameters {
  std::vector<Waypoint> waypoints{};      ///< 2 to 2000 of them
  bool loop{false};                       ///< from the last waypoint back to the first, and again
  double acceleration_mps2{1.0};          ///< most along the path, > 0
  double lateral_acceleration_mps2{2.0};  ///< most in a turn, > 0
  std::optional<double> turn_radius_m{};  ///< least; absent: from lateral acceleration and speed
  bool banks{false};                      ///< rolls into turns so that nothing pushes sideways
  std::optional<double> duration_s{};     ///< absent: the route's length, one lap of a loop
};

/// Arcs of great ellipses from waypoint to waypoint, at heights above the ellipsoid that change by
/// smooth steps between turns. A corner is rounded on the inside, over the turn radius and
/// at least one second (three when banking): the path does not touch a waypoint where it turns. It
/// is travelled as fast as the speeds and accelerations allow; a stop is made where the corner's
/// turn begins. The body points along the path, level across it or banked.
///
/// Height is exact to rounding; speeds, radii and lateral accelerations are within 0.2 % near the
/// latitude and height of the first waypoint, 0.5 % anywhere. Position, velocity, attitude and
/// angular rate are continuous; breaks_s are where higher derivatives jump. Angles are given to
/// first order: their second derivatives are zero.
/// @throws Error naming the waypoint or the field and the allowed range; also when a route that is
/// no loop is shorter than duration_s, or goes further than 7000 km from its start.
Trajectory waypoint_trajectory(const WaypointParameters& parameters);

}  // namespace leeway::sim
