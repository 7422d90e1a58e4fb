/// @file
/// Elasticities of the correction interval: by how many percent it changes when a specification
/// changes by one.
#pragma once

#include <limits>
#include <vector>

#include "leeway/sim/analysis/specification.hpp"

namespace leeway::sim {

/// The elasticity in one specification s: of the error E just before a fix, at a fixed interval,
/// and of the interval T that keeps the limit. Where the limit grows with the way, E is
/// the error over what is allowed.
struct Elasticity {
  Specification specification{};
  double of_error{};     ///< d ln E / d ln s
  double of_interval{};  ///< d ln T / d ln s; NaN where the error hardly grows with T
};

/// Elasticities at one interval.
struct Elasticities {
  double interval_s{};
  double error_m{};  ///< by the scene's metric
  /// d ln E / d ln T: the slope of the least squares line through five intervals within 21 %. A
  /// moving scene's error has kinks, where fixes come to meet other moments of the motion.
  double growth{};
  std::vector<Elasticity> each{};  ///< of what the scene has; the largest of_error first
};

/// Elasticities by central differences of 5 % in the specification, in the truth and in what the
/// filter takes for it: two analyses each.
/// @param track  error_track() of this scene
/// @throws Error when the scene is invalid, or unless 0.01 <= interval_s <=
/// longest_interval_s(scene).
Elasticities elasticities(const Scene& scene, const ErrorTrack& track, double interval_s);

}  // namespace leeway::sim
