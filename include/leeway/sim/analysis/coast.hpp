/// @file
/// Outages that a scene scripts: the error at the end of each, and the coast time, the time without
/// fixes that a limit allows (the term of RTCA DO-384).
#pragma once

#include <limits>
#include <vector>

#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// What an outage of a scene costs, by the truth-model covariance analysis.
struct Coast {
  Outage outage{};
  double end_s{};        ///< when the first fix after it arrives, or the scene's end
  double end_error_m{};  ///< then, by the scene's metric, before that fix is used
  double limit_m{};
  double share{};          ///< of the way since the last fix, allowed on top
  double end_allowed_m{};  ///< at end_s
  /// From the start of the outage until the error reaches the limit, had it no end. NaN when it
  /// does not within the scene.
  double coast_s{std::numeric_limits<double>::quiet_NaN()};

  bool keeps_limit() const { return end_error_m <= end_allowed_m; }
};

/// One for each outage of the scene, for its own metric and fix interval.
/// @param track  error_track() of this scene
/// @throws Error when the scene is invalid.
std::vector<Coast> coasts(const Scene& scene, const ErrorTrack& track,
                          const AllowedError& allowed);

}  // namespace leeway::sim
