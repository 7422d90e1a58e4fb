#include "leeway/sim/analysis/interval.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "leeway/model/error_metric.hpp"
#include "lib/earth/field_walk.hpp"
#include "sim/analysis/doubling/end_analysis.hpp"

namespace leeway::sim {
namespace {

constexpr double kFirstGuessS = 10.0;
constexpr double kShorterBy = 10.0;  // below the first guess the error falls evenly
constexpr double kLongerBy = 1.41;   // above it fixes come in step with the motion and out of it
constexpr int kMostSecants = 60;

void validate(const Scene& scene, const std::vector<AllowedError>& limits,
              const IntervalConfig& config) {
  for (const AllowedError& allowed : limits) {
    require("interval", "limit_m", allowed.limit_m, positive_to(1e6));
    require("interval", "share", allowed.share, between(0.0, 1.0));
  }
  const double below_longest_s = std::nextafter(longest_interval_s(scene), 0.0);
  require("interval", "shortest_s, below the longest that the scene can be asked for,",
          config.shortest_s, between(0.01, below_longest_s));
  require("interval", "first_guess_s", config.first_guess_s, kPositive);
  require("interval", "tolerance", config.tolerance, between(1e-6, 0.1));
}

/// A point of the curve of the error over what is allowed against the interval, in logarithms:
/// nearly a straight line, and above 0 beyond the limit.
struct Sample {
  double log_interval;
  double log_excess;

  bool is_beyond() const { return log_excess > 0.0; }
};

/// The scene, told to measure the way where one of the limits grows with it.
Scene with_way(Scene scene, const std::vector<AllowedError>& limits) {
  for (const AllowedError& allowed : limits) {
    scene.limit.share = std::max(scene.limit.share, allowed.share);
  }
  return scene;
}

class Solver {
 public:
  Solver(const Scene& scene, const std::vector<AllowedError>& limits, const IntervalConfig& config)
      : scene_(with_way(scene, limits)),
        config_(config),
        tracks_(config.tracks != nullptr ? *config.tracks : own_tracks_),
        track_(tracks_.of(scene, config.covariance_step_s)),
        log_longest_(std::log(longest_interval_s(scene))) {}

  Interval solve(const AllowedError& allowed) {
    Interval answer;
    answer.limit_m = allowed.limit_m;
    answer.share = allowed.share;
    const auto [below, above] = bracket(allowed);
    if (below.is_beyond()) {
      answer.outcome = Interval::Outcome::kNever;
      report(answer, below.log_interval);
      return answer;
    }
    if (!above.is_beyond()) answer.outcome = Interval::Outcome::kAlways;
    const double log_interval = answer.outcome == Interval::Outcome::kAlways
                                    ? log_longest_
                                    : narrow(below, above, allowed).log_interval;
    // No longer by rounding, which trials would refuse.
    answer.interval_s = std::min(std::exp(log_interval), longest_interval_s(scene_));
    report(answer, log_interval);
    return answer;
  }

  /// What halving the step changes. The last question: the track of whole steps is given up for it.
  void add_step_effects(std::vector<Interval>& answers) {
    analysis_.reset();
    track_ = tracks_.of(scene_, 0.5 * config_.covariance_step_s);
    analysis_.emplace(scene_, *track_);
    known_.clear();
    for (Interval& answer : answers) {
      const bool is_never = answer.outcome == Interval::Outcome::kNever;
      const double interval_s = is_never ? config_.shortest_s : answer.interval_s;
      // Fixes closer than half a step are the steps.
      if (interval_s <= 0.5 * config_.covariance_step_s) continue;
      auto found = known_.find(interval_s);
      if (found == known_.end()) {
        found = known_.emplace(interval_s, analysis_->at(interval_s)).first;
      }
      const double fine_m = found->second.true_errors.worst(answer.allowed()).error_m;
      answer.step_effect = std::abs(fine_m / answer.true_m - 1.0);
    }
  }

  void add_free_inertial(std::vector<Interval>& answers) const {
    ErrorBeforeFix before;
    double before_s = 0.0;
    free_inertial(scene_, *track_, [&](const CovariancePoint& point) {
      const Eigen::Matrix3d P_n_m2 = ned_covariance(point.r_e_m, point.truth.block<3, 3>(kDr, kDr));
      const ErrorBeforeFix now = error_before_fix(scene_, *track_, 0.0, point.t_s, P_n_m2);
      if (config_.free_inertial_observer) config_.free_inertial_observer(point.t_s, now.error_m);
      bool wanted = false;
      for (Interval& answer : answers) {
        if (!std::isnan(answer.free_inertial_s)) continue;
        wanted = true;
        const AllowedError allowed = answer.allowed();
        const double beyond_m = now.error_m - allowed.after_m(now.distance_m);
        if (beyond_m < 0.0) continue;
        const double left_m = allowed.after_m(before.distance_m) - before.error_m;
        const double part = left_m / (left_m + beyond_m);
        answer.free_inertial_s = before_s + part * (point.t_s - before_s);
      }
      before_s = point.t_s;
      before = now;
      return wanted;
    });
  }

 private:
  /// Every interval is analysed once, whatever limits ask for it.
  const CovarianceAnalysis& known(double log_interval) {
    const double interval_s = std::exp(log_interval);
    auto found = known_.find(interval_s);
    if (found == known_.end()) {
      found = known_.emplace(interval_s, analysis_->at(interval_s)).first;
      if (config_.observer) config_.observer(interval_s, found->second);
    }
    return found->second;
  }

  Sample sample(double log_interval, const AllowedError& allowed) {
    return {log_interval, std::log(known(log_interval).true_errors.worst(allowed).over(allowed))};
  }

  /// Two neighbours with the limit between them, or both the same at an end of what is tried. The
  /// error may fall again where fixes come in step with the motion: every interval on the way to
  /// the lower one keeps the limit, as far as the steps see it. They are the same for all limits.
  std::pair<Sample, Sample> bracket(const AllowedError& allowed) {
    const double log_shortest = std::log(config_.shortest_s);
    const auto guess = [&](double log_guess) {
      return sample(std::clamp(log_guess, log_shortest, log_longest_), allowed);
    };
    // On the same steps whatever is guessed: between them the error may rise and fall.
    const double log_longer = std::log(kLongerBy);
    const auto longer = [&](const Sample& s) {
      return sample(std::min(s.log_interval + log_longer, log_longest_), allowed);
    };
    const double log_known = std::log(config_.first_guess_s / kFirstGuessS);
    const double steps = std::max(std::floor(log_known / log_longer), 0.0);
    Sample below = guess(std::log(kFirstGuessS) + steps * log_longer);
    if (below.is_beyond()) below = guess(std::log(kFirstGuessS));
    const double log_first = below.log_interval;
    Sample above = below;
    while (below.is_beyond() && below.log_interval > log_shortest) {
      above = below;
      below = sample(std::max(below.log_interval - std::log(kShorterBy), log_shortest), allowed);
    }
    if (below.is_beyond()) {
      // What grows with the way may yet overtake the error.
      above = sample(log_first, allowed);
      while (allowed.share > 0.0 && above.is_beyond() && above.log_interval < log_longest_) {
        above = longer(above);
      }
      if (above.is_beyond()) return {below, below};
      below = above;
    }
    while (!above.is_beyond() && above.log_interval < log_longest_) {
      below = above;
      above = longer(above);
    }
    return {below, above};
  }

  /// Regula falsi with Illinois weights. @returns the last sample below the limit.
  Sample narrow(Sample below, Sample above, const AllowedError& allowed) {
    double below_weight = 1.0;
    double above_weight = 1.0;
    for (int i = 0; i < kMostSecants; ++i) {
      const double low = below_weight * below.log_excess;
      const double high = above_weight * above.log_excess;
      const double width = above.log_interval - below.log_interval;
      if (width < config_.tolerance || -low < config_.tolerance * below_weight) break;
      // Halves where the two errors tell no slope.
      const double part = std::clamp(-low / (high - low), 0.0, 1.0);
      const Sample next =
          sample(below.log_interval + width * (std::isfinite(part) ? part : 0.5), allowed);
      if (!next.is_beyond()) {
        below = next;
        below_weight = 1.0;
        above_weight *= 0.5;
      } else {
        above = next;
        above_weight = 1.0;
        below_weight *= 0.5;
      }
    }
    return below;
  }

  void report(Interval& answer, double log_interval) {
    const AllowedError allowed = answer.allowed();
    const CovarianceAnalysis& analysis = known(log_interval);
    const ErrorBeforeFix worst = analysis.true_errors.worst(allowed);
    answer.true_m = worst.error_m;
    answer.allowed_m = allowed.after_m(worst.distance_m);
    answer.claimed_m = analysis.claimed_errors.worst(allowed).error_m;
    answer.settled = analysis.settled;
  }

  Scene scene_;
  const IntervalConfig& config_;
  SceneTracks own_tracks_{};
  SceneTracks& tracks_;
  std::optional<ErrorTrack> track_;
  std::optional<EndAnalysis> analysis_{std::in_place, scene_, *track_};
  double log_longest_;
  std::map<double, CovarianceAnalysis> known_{};  // by interval
};

}  // namespace

std::vector<Interval> solve_intervals(const Scene& scene, const std::vector<AllowedError>& limits,
                                      const IntervalConfig& config,
                                      const std::function<void(double fraction)>& progress) {
  validate(scene);
  validate(scene, limits, config);
  Solver solver(scene, limits, config);
  std::vector<Interval> answers;
  for (const AllowedError& allowed : limits) {
    answers.push_back(solver.solve(allowed));
    if (progress) {
      progress(static_cast<double>(answers.size()) / static_cast<double>(limits.size()));
    }
  }
  solver.add_free_inertial(answers);
  if (config.with_step_effect) solver.add_step_effects(answers);
  return answers;
}

}  // namespace leeway::sim
