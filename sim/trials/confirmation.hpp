/// @file
/// The nonlinear check of a solved interval: does the filter, run for real, err as the linear
/// analysis says?
#pragma once

#include <functional>
#include <optional>

#include "leeway/sim/analysis/interval.hpp"
#include "leeway/sim/trials/campaign.hpp"

namespace leeway::sim {

/// What the Monte Carlo found at a solved interval.
struct Confirmation {
  CampaignResult campaign{};
  double rms_over_true{};  ///< to the linear analysis, which knows the unmodelled errors
  /// The filter errs as much as it claims and as the linear analysis says: NEES and the squared RMS
  /// within the band that an honest filter leaves once in a thousand times, and no trial diverged.
  bool consistent{false};
  /// Where it is not: the interval at which the Monte Carlo's error meets the limit.
  std::optional<double> interval_s{};
};

/// The check by the scene's trials, and the search for a better interval where it fails.
/// @param track     error_track() of the scene
/// @param progress  called with the fraction done, of each campaign anew
Confirmation confirm(const Scene& scene, const ErrorTrack& track, const Interval& answer,
                     const std::function<void(double fraction)>& progress);

}  // namespace leeway::sim
