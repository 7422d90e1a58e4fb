/// @file
/// The factor on some specifications at which a scene's error meets its limit. Part of inverse.
#pragma once

#include "leeway/sim/analysis/inverse.hpp"

namespace leeway::sim {

/// What all searches at one interval share.
struct FactorQuestion {
  const Scene& scene;  ///< at the interval
  const ErrorTrack& track;
  const CovarianceAnalysis& own;  ///< of this scene, by source
  double limit_m{};
  double tolerance{};  ///< relative, of the error
};

/// The factor, by a few analyses. @param name, what  as the answer has them
NeededFactor needed_factor(const FactorQuestion& question, std::string name,
                           std::vector<Specification> what);

}  // namespace leeway::sim
