/// @file
/// The path of a trajectory: how far it has gone, and its course where it stands.
#pragma once

#include <memory>

#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

/// A path, in pieces of half a second or a little less; of a trajectory that repeats, over one
/// period. It is tabulated when it is first asked, once for all copies, by any thread.
class GroundPath {
 public:
  /// @pre 0 < duration_s.
  GroundPath(const Trajectory& trajectory, double duration_s);

  /// Length in m of the way between two times, heights included. The velocity at the middle of a
  /// piece is held over it: exact while the speed changes evenly.
  /// @pre 0 <= from_s <= to_s <= duration.
  double distance_m(double from_s, double to_s) const;

  /// Course over ground at a time, rad clockwise from north. Where the vehicle stands, below
  /// kStandingMps, the last it had; before any motion the heading.
  /// @pre 0 <= t_s <= duration.
  double course_rad(double t_s) const;

 private:
  struct Table;

  const Table& table() const;

  std::shared_ptr<Table> table_;
};

}  // namespace leeway::sim
