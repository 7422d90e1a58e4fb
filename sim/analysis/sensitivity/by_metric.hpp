/// @file
/// The size of a position error by a scene's metric, from its covariance in north, east, down. Part
/// of predictions, which analyses then verify: a metric that asks for the course has it northwards.
#pragma once

#include <Eigen/Core>

#include "leeway/model/error_metric.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

inline double size_by_metric_m(const Scene& scene, const Eigen::Matrix3d& P_n_m2) {
  return error_size_m(scene.limit.metric, P_n_m2, 0.0);
}

}  // namespace leeway::sim
