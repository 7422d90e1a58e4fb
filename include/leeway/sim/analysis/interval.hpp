/// @file
/// The correction interval: the longest time between fixes for which the error just before each of
/// them stays within a limit. What Leeway exists to answer.
#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/analysis/scene_tracks.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// Options of solve_intervals().
struct IntervalConfig {
  double shortest_s{0.1};  ///< intervals from here to longest_interval_s() are tried
  /// Known to keep the limit as long as this one does: the answer with less aiding, say.
  double first_guess_s{10.0};
  double tolerance{1e-3};  ///< relative, of the interval or of the error reached
  double covariance_step_s{1.0};
  bool with_step_effect{true};   ///< whether Interval::step_effect is wanted
  SceneTracks* tracks{nullptr};  ///< unless null, of this motion: shared with other questions
  /// Called with every interval that is analysed on the way, in no order.
  std::function<void(double interval_s, const CovarianceAnalysis&)> observer{};
  /// Called on the way to free_inertial_s, with the error by the scene's metric.
  std::function<void(double t_s, double error_m)> free_inertial_observer{};
};

/// The answer for one limit, by the scene's metric.
struct Interval {
  enum class Outcome {
    kSolved,
    kNever,   ///< even at the shortest interval the error exceeds the limit; interval_s is NaN
    kAlways,  ///< even at longest_interval_s(), which is interval_s, the error stays below
  };
  double limit_m{};
  double share{};  ///< of the way since the last fix, allowed on top
  Outcome outcome{Outcome::kSolved};
  double interval_s{std::numeric_limits<double>::quiet_NaN()};
  double true_m{};     ///< the worst error reached at this interval
  double allowed_m{};  ///< before that fix
  double claimed_m{};  ///< the worst that the filter claims
  bool settled{};      ///< whether the filter has settled by the scene's end
  /// Without fixes from a perfect start, no calibration: the time to the limit. NaN when it is not
  /// reached within the scene.
  double free_inertial_s{std::numeric_limits<double>::quiet_NaN()};
  /// Relative change of true_m when the covariance step is halved: what the step costs.
  double step_effect{};

  AllowedError allowed() const { return {limit_m, share}; }
};

constexpr auto names(Interval::Outcome) { return std::array{"solved", "never", "always"}; }

/// The correction interval for each limit, by bracketing and secants in log(error / allowed) over
/// log(interval) on the truth-model covariance analysis; the scene's own gnss.interval_s and limit
/// are not used, its metric is. An answer does not depend on what other limits are asked for.
/// Where a limit grows with the way, short intervals may break it and longer ones keep it: the
/// answer is then the end of a range of intervals that keep it.
/// @param progress  called with the fraction done
/// @throws Error when the scene, the configuration or a limit is invalid.
std::vector<Interval> solve_intervals(const Scene& scene, const std::vector<AllowedError>& limits,
                                      const IntervalConfig& config = {},
                                      const std::function<void(double fraction)>& progress = {});

}  // namespace leeway::sim
