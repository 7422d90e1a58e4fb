/// @file
/// The covariances of a scene over many fixes at once where its motion repeats: by doubling. Part
/// of covariance_analysis.
#pragma once

#include <optional>

#include "sim/analysis/doubling/stretch.hpp"
#include "sim/analysis/scene_covariance.hpp"

namespace leeway::sim {

/// The fixes that are taken in one go: one every interval_s after from_s, up to until_s at most.
struct FixSpan {
  double from_s{};  ///< of a fix that has been used
  double until_s{};
  double interval_s{};
  double weight{1.0};  ///< of the positions, by gnss_position_weight()
};

/// Fixes after which motion and fixes begin anew.
struct FixPattern {
  int fixes{};
  double interval_s{};  ///< that of the span, or one near it
  double length_s{};
  double row_weight{1.0};  ///< with which fixes at another interval tell as much in the same time
};

/// The pattern of the fixes of a span on a track: of one fix where the vehicle stands still, or of
/// as many as are in some periods of the motion. Fixes that are dense in the motion, 16 or more a
/// period, may be moved a little: to an interval that is a whole fraction of the period.
/// @returns none where nothing repeats often enough to be worth it
std::optional<FixPattern> fix_pattern(const Scene& scene, const ErrorTrack& track,
                                      const FixSpan& span);

/// What both covariances become over the pattern, as often as it fits into the span.
/// @pre pair.takes_stretches(), and nothing is held at a fix
/// @returns the time of the last fix taken
double repeat_fixes(SceneCovariance<0>& pair, const Scene& scene, Stretches& stretches,
                    const FixSpan& span, const FixPattern& pattern);

}  // namespace leeway::sim
