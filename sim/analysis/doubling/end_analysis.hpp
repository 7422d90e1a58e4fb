/// @file
/// The analysis of a scene for those who ask for its end alone, at one fix interval after the
/// other.
#pragma once

#include <optional>
#include <tuple>
#include <vector>

#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "sim/analysis/doubling/stretch.hpp"
#include "sim/analysis/scene_covariance.hpp"
#include "sim/analysis/settling.hpp"

namespace leeway::sim {

/// A filter that gnss.settle_s of fixes have settled: the same whatever interval comes then.
template <int kParameters>
struct SettledFilter {
  SceneCovariance<kParameters> pair;
  std::vector<VariancesBefore> fixes{};
};

/// As analyze(), with less work. What lies between two fixes is taken at once; where the motion
/// repeats all fixes up to the last parts of the scene are, by doubling; fixes closer than a step,
/// or than a few of steady motion, are taken as one where they change little; the fixes that settle
/// the filter are followed once for all intervals.
class EndAnalysis {
 public:
  /// @param track  error_track() of the scene; both must live as long as this
  EndAnalysis(const Scene& scene, const ErrorTrack& track)
      : scene_(scene), track_(track), stretches_(scene_, track) {}

  /// Of the scene with gnss.interval_s. settled_s is no earlier than the last parts of the scene.
  CovarianceAnalysis at(double interval_s);

 private:
  template <int kParameters>
  using Settled = std::optional<SettledFilter<kParameters>>;

  /// @param most_steps  whose fixes are taken as one. @returns none where they change too much
  std::optional<CovarianceAnalysis> run(int most_steps);

  Scene scene_;
  const ErrorTrack& track_;
  Stretches stretches_;
  std::tuple<Settled<0>, Settled<kVehicleStates>> settled_{};
};

}  // namespace leeway::sim
