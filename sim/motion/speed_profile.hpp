/// @file
/// How fast a path is travelled: distance as a closed form of time, from speed limits along it.
#pragma once

#include <vector>

#include "leeway/sim/motion/jet.hpp"

namespace leeway::sim {

/// A place on the path. Between it and the next one the speed is at most speed_after_mps.
struct SpeedNode {
  double s_m{};              ///< ascending from node to node
  double speed_mps{};        ///< at most, when passing the node; 0: a stop
  double speed_after_mps{};  ///< > 0
  double rest_s{0.0};        ///< at a stop
};

/// Distance against time: as fast as the limits allow. Speed changes are smooth steps, so distance
/// is three times continuously differentiable.
class SpeedProfile {
 public:
  /// @param loop  the last node is the first one again
  /// @pre two nodes or more, acceleration > 0.
  SpeedProfile(std::vector<SpeedNode> nodes, double acceleration_mps2, bool loop);

  /// Distance since the first node, with its derivatives. @pre 0 <= t_s; the end is held.
  Jet distance_m(double t_s) const;

  double duration_s() const { return duration_s_; }

  /// Where one step of speed gives way to another: times within (0, duration).
  std::vector<double> breaks_s() const;

 private:
  /// From one speed to another, smoothly; alike where nothing changes.
  struct Ramp {
    double start_s;
    double length_s;
    double start_m;
    double from_mps;
    double to_mps;
  };

  void add(double length_s, double from_mps, double to_mps);
  void add_change(double from_mps, double to_mps);
  void add_section(const SpeedNode& from, const SpeedNode& to);

  double smooth_acceleration_mps2_;  // mean over a smooth step whose peak is the limit
  std::vector<Ramp> ramps_{};
  double duration_s_{0.0};
  double end_m_{0.0};
};

}  // namespace leeway::sim
