/// @file
/// Rates of a trajectory by finite differences.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

/// Whether a stencil of +-0.02 s around t stays well away from every break.
inline bool is_smooth_at(const Trajectory& trajectory, double t_s) {
  return std::none_of(trajectory.breaks_s.begin(), trajectory.breaks_s.end(),
                      [t_s](double break_s) { return std::abs(t_s - break_s) < 0.05; });
}

/// Fourth-order central difference.
template <class Function>
Eigen::Vector3d rate_of(const Function& f, double t_s, double h_s) {
  return (8.0 * (f(t_s + h_s) - f(t_s - h_s)) - (f(t_s + 2.0 * h_s) - f(t_s - 2.0 * h_s))) /
         (12.0 * h_s);
}

}  // namespace leeway::sim
