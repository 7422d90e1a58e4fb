/// @file
/// What the covariance analysis expects of a log whose fixes are thinned: its own motion, the same
/// IMU model, aiding and filter, a receiver as good as the log's.
#pragma once

#include <memory>
#include <vector>

#include "leeway/sim/analysis/error_track.hpp"
#include "leeway/sim/scene/scene.hpp"
#include "sim/replay/log_survey.hpp"

namespace leeway::sim {

class ExpectedErrors {
 public:
  /// @throws Error when the motion cannot be made a scene of.
  ExpectedErrors(const ReplayInput& input, const LogSurvey& survey, const NavigatorConfig& config,
                 ErrorMetric metric);

  const Scene& scene() const { return scene_; }

  /// Before every fix after a thinning's start, one each of its intervals.
  /// @param wanted  tells of the time of a fix in s whether it counts
  /// @param against_fixes  the error is the way to a fix of that time, which errs itself
  std::vector<Eigen::Vector2d> variances_m2(const Thinning& thinning, bool against_fixes,
                                            const std::function<bool(double)>& wanted) const;

 private:
  double start_s_;  // of the scene, by the clock of the log
  Scene scene_;
  std::optional<ErrorTrack> track_{};
};

}  // namespace leeway::sim
