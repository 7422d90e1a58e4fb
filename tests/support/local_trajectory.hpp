/// @file
/// Trajectories that a test makes up.
#pragma once

#include <functional>
#include <utility>

#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::test {

/// A motion about the default origin.
inline sim::Trajectory local_trajectory(
    double duration_s, std::function<sim::LocalMotion(double t_s)> motion) {
  sim::Trajectory trajectory;
  trajectory.name = "local";
  trajectory.plane = sim::TangentPlane(sim::kDefaultOrigin);
  trajectory.duration_s = duration_s;
  trajectory.motion = std::move(motion);
  return trajectory;
}

}  // namespace leeway::test
