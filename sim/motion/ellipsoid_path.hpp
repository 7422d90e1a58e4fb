/// @file
/// A path over the Earth: arcs of great ellipses between corners, rounded there, at heights above
/// the ellipsoid.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "sim/motion/jet_vector.hpp"

namespace leeway::sim {

/// A corner of the path, before it is rounded.
struct Corner {
  Geodetic position{};
  double turn_radius_m{};    ///< least radius of the rounded corner, > 0
  double shortest_turn_m{};  ///< a corner that turns a little is rounded over this at least
};

/// Where a corner's rounding begins and ends, as distances along the path.
struct TurnSpan {
  double start_m{};
  double end_m{};
};

/// A point of the path as functions of the distance along it.
struct PathPoint {
  JetVector position_e_m{};  ///< in ECEF
  JetVector up_e{};          ///< outward normal of the ellipsoid, unit length
  Jet curvature_per_m{};     ///< on the ground; right is positive
};

/// The ellipsoid is the unit sphere, stretched: its great circles are the arcs here, and distances
/// are the sphere's times one radius, which fits at the path's first corner. On the ground they are
/// at most 0.2 % longer or shorter where the path stays at that latitude and height, 0.5 %
/// anywhere. A turn's curvature rises and falls smoothly; heights change by smooth steps on the
/// arcs, not in turns. Position, direction and curvature are continuous.
class EllipsoidPath {
 public:
  /// @param loop  from the last corner back to the first; the path then begins where the first one
  /// begins to turn, and ends there
  /// @throws Error naming the corner where two are closer than 0.1 m or further than 9000 km, a
  /// turn is sharper than 150 deg, turns overlap, or a slope is steeper than 45 deg.
  /// @pre two corners or more.
  EllipsoidPath(const std::vector<Corner>& corners, bool loop);

  /// One for each corner, and for a loop one more: the first again, at the end.
  const std::vector<TurnSpan>& turns() const { return turns_; }

  /// @pre 0 <= s_m <= end of the path.
  PathPoint at(double s_m) const;

 private:
  /// The plane of a corner, in which the arcs to and from it are straight lines: x along the one
  /// that arrives, y to the right of it.
  struct Node {
    Eigen::Vector3d up{Eigen::Vector3d::UnitX()};  // on the unit sphere
    Eigen::Vector3d ahead{Eigen::Vector3d::Zero()};
    Eigen::Vector3d right{Eigen::Vector3d::Zero()};
    double turn_rad{0.0};  // right is positive
    double turn_m{0.0};    // length of the turn
    double cut_m{0.0};     // from where the turn begins to the corner
    double height_m{0.0};
  };

  void direct(std::size_t k, const Eigen::Vector3d& from, const Eigen::Vector3d& to);
  void measure(const std::vector<double>& legs_m, bool loop);
  std::size_t next_turn(double s_m) const;
  JetVector on_sphere(const Jet& s_m, std::size_t node) const;
  Jet height_m(const Jet& s_m) const;
  Jet curvature_per_m(const Jet& s_m, std::size_t node) const;

  double radius_m_{wgs84::kSemiMajorAxisM};
  std::vector<Node> nodes_{};
  std::vector<TurnSpan> turns_{};
};

}  // namespace leeway::sim
