/// @file
/// The analysis of a scene for those who ask for its end alone, again and again.
#pragma once

#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "sim/analysis/doubling/stretch.hpp"

namespace leeway::sim {

/// As analyze(), in fewer and longer steps: what lies between two fixes is taken at once, and where
/// the motion repeats all fixes up to the last parts of the scene are, by doubling. settled_s is no
/// earlier than these parts.
/// @param stretches  of this scene with any GNSS
CovarianceAnalysis analyze_end(const Scene& scene, Stretches& stretches);

}  // namespace leeway::sim
