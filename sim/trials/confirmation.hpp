/// @file
/// The nonlinear check of a solved interval: does the scene's estimator, run for real, err as the
/// linear analysis says?
#pragma once

#include <functional>
#include <optional>

#include "leeway/earth/names.hpp"
#include "leeway/sim/analysis/interval.hpp"
#include "leeway/sim/trials/campaign.hpp"

namespace leeway::sim {

/// What an answer rests on.
enum class Mark {
  kLinear,    ///< the linear analysis alone
  kChecked,   ///< trials err as it says, within kAgreement
  kByTrials,  ///< they do not: the answer is theirs
};
constexpr auto names(Mark) { return std::array{"linear", "checked", "by trials"}; }

/// By how much, as a ratio, trials may err otherwise than the linear analysis says. The interval
/// goes about as the error does.
inline constexpr double kAgreement = 1.1;

/// What trials found at a solved interval.
struct Confirmation {
  CampaignResult campaign{};
  double rms_over_true{};  ///< horizontal, to the linear analysis with the unmodelled errors
  /// The same by the scene's metric: of a radius that 95 % stay within, the one of the errors, each
  /// over the linear one at its fix; else the RMS.
  double error_over_true{};
  double scatter{};  ///< its relative 1 sigma, by leaving out one trial at a time
  /// The trials err as the linear analysis says: by no more than kAgreement as far as their scatter
  /// tells, and none diverged.
  bool agrees{false};
  /// And the filter errs as much as it claims: NEES, and the squared RMS of the axes that the
  /// metric measures, within the band that an honest filter leaves once in a thousand times.
  /// Along and across the track: the horizontal axes.
  bool consistent{false};
  /// Where they do not agree: the interval at which their error meets the limit. Nothing where no
  /// interval that was tried keeps it.
  std::optional<double> interval_s{};
  int trials_run{0};  ///< in all, the search included

  Mark mark() const { return agrees ? Mark::kChecked : Mark::kByTrials; }
};

/// The check by so many trials as the scene has, and the search for a better interval where it
/// fails. @throws Error where the scene cannot be run at this interval.
/// @param track     error_track() of the scene
/// @param ranks     share the trials; each gets the answer, the same to the bit on any number
/// @param progress  called with the fraction done, of each set of trials anew
Confirmation confirm(const Scene& scene, const ErrorTrack& track, const Interval& answer,
                     const Ranks& ranks, const std::function<void(double fraction)>& progress);

inline constexpr int kFewestTrials = 8;
inline constexpr int kMostTrials = 32;

/// The same by as few trials as tell, kFewestTrials to kMostTrials.
Confirmation check(const Scene& scene, const ErrorTrack& track, const Interval& answer,
                   const Ranks& ranks, const std::function<void(double fraction)>& progress);

}  // namespace leeway::sim
