/// @file
/// The size of a position error by a scene's metric, from its covariance in north, east, down.
#pragma once

#include <Eigen/Core>

#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

inline double size_by_metric_m(const Scene& scene, const Eigen::Matrix3d& P_n_m2) {
  return horizontal_error_m(scene.limit.metric, P_n_m2.topLeftCorner<2, 2>());
}

}  // namespace leeway::sim
