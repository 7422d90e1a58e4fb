#include "sim/motion/ellipsoid_path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "sim/motion/smooth_step.hpp"

namespace leeway::sim {
namespace {

constexpr double kEquatorM = wgs84::kSemiMajorAxisM;
constexpr double kPoleM = wgs84::kSemiMinorAxisM;
constexpr double kShortestLegM = 0.1;
constexpr double kLongestLegM = 9e6;
constexpr double kSharpestTurnRad = 150.0 * kRadPerDeg;
constexpr double kStraightRad = 1e-9;
constexpr double kSteepestSlope = 1.0;

template <class... Parts>
[[noreturn]] void refuse(std::size_t corner, const Parts&... parts) {
  std::ostringstream message;
  message << "waypoint " << corner + 1 << ": ";
  (message << ... << parts);
  throw Error(message.str());
}

/// The point of the unit sphere that is stretched to the ellipsoid's point with this normal.
Eigen::Vector3d sphere_point(const Geodetic& position) {
  const double cos_lat = std::cos(position.lat_rad);
  return Eigen::Vector3d(kEquatorM * cos_lat * std::cos(position.lon_rad),
                         kEquatorM * cos_lat * std::sin(position.lon_rad),
                         kPoleM * std::sin(position.lat_rad))
      .normalized();
}

/// Mean over all directions, nearly, of what a unit of the sphere measures on the ground.
double ground_radius_m(const Geodetic& position) {
  const double z = sphere_point(position).z();
  const double meridian_m =
      std::sqrt(kEquatorM * kEquatorM * z * z + kPoleM * kPoleM * (1.0 - z * z));
  return 0.5 * (kEquatorM + meridian_m) + position.height_m;
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

struct Point {
  double x, y;
};

/// Nodes on 0 to 1 and weights of the Gauss-Legendre rule: roots of the polynomial by Newton's
/// method.
struct GaussLegendre {
  static constexpr std::size_t kNodes = 24;
  std::array<double, kNodes> node{};
  std::array<double, kNodes> weight{};

  GaussLegendre() {
    const double n = static_cast<double>(kNodes);
    for (std::size_t i = 0; i < kNodes; ++i) {
      double x = std::cos(std::numbers::pi * (static_cast<double>(i) + 0.75) / (n + 0.5));
      double slope = 1.0;
      for (int iteration = 0; iteration < 6; ++iteration) {
        double before = 1.0;
        double p = x;
        for (double k = 2.0; k <= n; ++k) {
          const double next = ((2.0 * k - 1.0) * x * p - (k - 1.0) * before) / k;
          before = p;
          p = next;
        }
        slope = n * (x * p - before) / (x * x - 1.0);
        x -= p / slope;
      }
      node[i] = 0.5 * (1.0 + x);
      weight[i] = 1.0 / ((1.0 - x * x) * slope * slope);
    }
  }
};

/// Where a turn of unit length has led when a fraction of it is done. The integrand bends by less
/// than one wave over the turn: 24 nodes integrate it to rounding.
Point turn_point(double turn_rad, double fraction) {
  static const GaussLegendre rule;
  Point sum{0.0, 0.0};
  for (std::size_t i = 0; i < GaussLegendre::kNodes; ++i) {
    const double direction_rad = turn_rad * smooth_step(fraction * rule.node[i]);
    sum.x += rule.weight[i] * std::cos(direction_rad);
    sum.y += rule.weight[i] * std::sin(direction_rad);
  }
  return {fraction * sum.x, fraction * sum.y};
}

/// Of a turn of unit length: how far before the corner it begins. Half the chord, over the cosine
/// of half the angle.
double turn_cut(double turn_rad) {
  const Point end = turn_point(turn_rad, 1.0);
  return 0.5 * std::hypot(end.x, end.y) / std::cos(0.5 * turn_rad);
}

/// cos(sqrt q) and sin(sqrt q) / sqrt q by their series, good to rounding for q <= 2.
struct CosineAndSinc {
  Jet cosine{};
  Jet sinc{};

  explicit CosineAndSinc(const Jet& q) {
    for (int k = 14; k > 0; --k) {
      cosine = 1.0 - q * cosine / ((2.0 * k - 1.0) * (2.0 * k));
      sinc = 1.0 - q * sinc / ((2.0 * k) * (2.0 * k + 1.0));
    }
  }
};

}  // namespace

EllipsoidPath::EllipsoidPath(const std::vector<Corner>& corners, bool loop)
    : radius_m_(ground_radius_m(corners.front().position)) {
  const std::size_t count = corners.size();
  for (const Corner& corner : corners) {
    Node node;
    node.up = sphere_point(corner.position);
    node.height_m = corner.position.height_m;
    nodes_.push_back(node);
  }
  std::vector<double> legs_m;
  for (std::size_t k = 0; k + (loop ? 0 : 1) < count; ++k) {
    const std::size_t next = (k + 1) % count;
    legs_m.push_back(radius_m_ * angle_between(nodes_[k].up, nodes_[next].up));
    if (!(legs_m[k] >= kShortestLegM && legs_m[k] <= kLongestLegM)) {
      refuse(k, "the next one is ", legs_m[k],
             " m away over the ground, must be 0.1 m to 9000 km; to wait at a place use stop_s");
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    const bool is_first = k == 0 && !loop;
    const bool is_last = k + 1 == count && !loop;
    const Eigen::Vector3d& up = nodes_[k].up;
    direct(k, is_first ? up : nodes_[(k + count - 1) % count].up,
           is_last ? up : nodes_[(k + 1) % count].up);
    const double turn_rad = std::abs(nodes_[k].turn_rad);
    if (turn_rad < kStraightRad) {
      nodes_[k].turn_rad = 0.0;
    } else {
      nodes_[k].turn_m = std::max(kSmoothStepMaxSlope * turn_rad * corners[k].turn_radius_m,
                                  corners[k].shortest_turn_m);
    }
    nodes_[k].cut_m = nodes_[k].turn_m * turn_cut(nodes_[k].turn_rad);
  }
  measure(legs_m, loop);
}

/// Directions of the arcs at a corner. An open path's first and last corner have one arc only.
void EllipsoidPath::direct(std::size_t k, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Node& node = nodes_[k];
  const auto along = [&node](const Eigen::Vector3d& axis) {
    return axis.cross(node.up).normalized().eval();
  };
  const bool arrives = from != node.up;
  const bool leaves = to != node.up;
  const Eigen::Vector3d out = leaves ? along(node.up.cross(to)) : along(from.cross(node.up));
  node.ahead = arrives ? along(from.cross(node.up)) : out;
  node.right = node.ahead.cross(node.up);
  node.turn_rad = std::atan2(out.dot(node.right), out.dot(node.ahead));
  if (std::abs(node.turn_rad) > kSharpestTurnRad) {
    refuse(k, "the path turns by ", std::abs(node.turn_rad) / kRadPerDeg,
           " deg, must be at most 150: make it two turns");
  }
}

void EllipsoidPath::measure(const std::vector<double>& legs_m, bool loop) {
  const std::size_t count = nodes_.size();
  if (loop) nodes_.push_back(nodes_.front());
  double s_m = 0.0;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    turns_.push_back({s_m, s_m + nodes_[k].turn_m});
    if (k == legs_m.size()) break;
    const Node& next = nodes_[(k + 1) % nodes_.size()];
    const double straight_m = legs_m[k] - nodes_[k].cut_m - next.cut_m;
    if (straight_m < 0.0) {
      refuse(k, "its turn takes ", nodes_[k].cut_m, " m and the next ", next.cut_m, " m of the ",
             legs_m[k], " m between them: lower the speed or the turn radius, or set them apart");
    }
    const double climb_m = std::abs(next.height_m - nodes_[k].height_m);
    if (kSmoothStepMaxSlope * climb_m > kSteepestSlope * straight_m) {
      refuse(k, "the height changes by ", climb_m, " m over the ", straight_m,
             " m of straight path to waypoint ", (k + 1) % count + 1, ", steeper than 45 deg");
    }
    s_m = turns_.back().end_m + straight_m;
  }
}

/// Index of the first turn that begins beyond s, or their number.
std::size_t EllipsoidPath::next_turn(double s_m) const {
  const auto next =
      std::upper_bound(turns_.begin(), turns_.end(), s_m,
                       [](double s, const TurnSpan& turn) { return s < turn.start_m; });
  return static_cast<std::size_t>(next - turns_.begin());
}

JetVector EllipsoidPath::on_sphere(const Jet& s_m, std::size_t k) const {
  const Node& node = nodes_[k];
  Jet x = s_m - turns_[k].start_m - node.cut_m;
  Jet y = 0.0;
  if (s_m.value > turns_[k].end_m) {
    const Jet out_m = s_m - turns_[k].end_m + node.cut_m;
    x = std::cos(node.turn_rad) * out_m;
    y = std::sin(node.turn_rad) * out_m;
  } else if (s_m.value > turns_[k].start_m) {
    const Jet fraction = (s_m - turns_[k].start_m) / node.turn_m;
    const Point at = turn_point(node.turn_rad, fraction.value);
    const Jet direction_rad = node.turn_rad * smooth_step(fraction);
    const Jet ahead = cos(direction_rad);
    const Jet right = sin(direction_rad);
    x = Jet(node.turn_m * at.x - node.cut_m, ahead.value, ahead.first);
    y = Jet(node.turn_m * at.y, right.value, right.first);
  }
  x = x / radius_m_;
  y = y / radius_m_;
  const CosineAndSinc turned(x * x + y * y);
  return scaled(node.up, turned.cosine) +
         turned.sinc * (scaled(node.ahead, x) + scaled(node.right, y));
}

Jet EllipsoidPath::height_m(const Jet& s_m) const {
  const std::size_t next = next_turn(s_m.value);
  const double from_m = nodes_[next == 0 ? 0 : next - 1].height_m;
  if (next == 0 || next == turns_.size() || s_m.value <= turns_[next - 1].end_m) return from_m;
  const double start_m = turns_[next - 1].end_m;
  const Jet fraction = (s_m - start_m) / (turns_[next].start_m - start_m);
  return from_m + (nodes_[next].height_m - from_m) * smooth_step(fraction);
}

Jet EllipsoidPath::curvature_per_m(const Jet& s_m, std::size_t k) const {
  if (!(s_m.value > turns_[k].start_m && s_m.value < turns_[k].end_m)) return 0.0;
  const Node& node = nodes_[k];
  return node.turn_rad / node.turn_m * smooth_step_slope((s_m - turns_[k].start_m) / node.turn_m);
}

PathPoint EllipsoidPath::at(double distance_m) const {
  // A node serves from the middle of the straight before it to the middle of the one after.
  std::size_t k = next_turn(distance_m);
  if (k == turns_.size() ||
      (k > 0 && distance_m < 0.5 * (turns_[k - 1].end_m + turns_[k].start_m))) {
    --k;
  }
  const Jet s_m = time_jet(distance_m);
  const JetVector u = on_sphere(s_m, k);
  PathPoint point;
  point.up_e = normalized({u.x / kEquatorM, u.y / kEquatorM, u.z / kPoleM});
  point.position_e_m =
      JetVector{kEquatorM * u.x, kEquatorM * u.y, kPoleM * u.z} + height_m(s_m) * point.up_e;
  point.curvature_per_m = curvature_per_m(s_m, k);
  return point;
}

}  // namespace leeway::sim
