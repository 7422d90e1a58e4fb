#include "leeway/sim/analysis/interval.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "lib/earth/field_walk.hpp"
#include "sim/analysis/end_analysis.hpp"

namespace leeway::sim {
namespace {

constexpr double kFirstGuessS = 10.0;
constexpr double kShorterBy = 10.0;  // below the first guess the error falls evenly
constexpr double kLongerBy = 1.41;   // above it fixes come in step with the motion and out of it
constexpr int kMostSecants = 60;

void validate(const Scene& scene, const std::vector<double>& limits_m,
              const IntervalConfig& config) {
  for (const double limit_m : limits_m) require("interval", "limit_m", limit_m, positive_to(1e6));
  const double half_s = std::nextafter(0.5 * scene.duration_s, 0.0);
  require("interval", "shortest_s, below half the scene's duration,", config.shortest_s,
          between(0.01, half_s));
  require("interval", "tolerance", config.tolerance, between(1e-6, 0.1));
}

/// A point of the curve error over interval, in logarithms: nearly a straight line.
struct Sample {
  double log_interval;
  double log_error;
};

class Solver {
 public:
  Solver(const Scene& scene, const IntervalConfig& config)
      : scene_(scene),
        config_(config),
        track_(error_track(scene, config.covariance_step_s)),
        stretches_(scene, track_),
        log_longest_(std::log(0.5 * scene.duration_s)) {}

  Interval solve(double limit_m) {
    Interval answer;
    answer.limit_m = limit_m;
    const double log_limit = std::log(limit_m);
    const auto [below, above] = bracket(log_limit);
    if (below.log_error > log_limit) {
      answer.outcome = Interval::Outcome::kNever;
      report(answer, below.log_interval);
      return answer;
    }
    if (above.log_error <= log_limit) answer.outcome = Interval::Outcome::kAlways;
    const double log_interval = answer.outcome == Interval::Outcome::kAlways
                                    ? log_longest_
                                    : narrow(below, above, log_limit).log_interval;
    answer.interval_s = std::exp(log_interval);
    report(answer, log_interval);
    return answer;
  }

  void add_free_inertial(std::vector<Interval>& answers) const {
    double before_s = 0.0;
    double before_m = 0.0;
    free_inertial(scene_, track_, [&](const CovariancePoint& point) {
      const double error_m =
          horizontal_error_m(scene_.limit.metric,
                             horizontal_covariance(point.r_e_m, point.truth.block<3, 3>(kDr, kDr)));
      if (config_.free_inertial_observer) config_.free_inertial_observer(point.t_s, error_m);
      bool wanted = false;
      for (Interval& answer : answers) {
        if (!std::isnan(answer.free_inertial_s)) continue;
        wanted = true;
        if (error_m < answer.limit_m) continue;
        const double share = (answer.limit_m - before_m) / (error_m - before_m);
        answer.free_inertial_s = before_s + share * (point.t_s - before_s);
      }
      before_s = point.t_s;
      before_m = error_m;
      return wanted;
    });
  }

 private:
  CovarianceAnalysis analysis_at(double log_interval, Stretches& stretches) const {
    Scene scene = scene_;
    scene.gnss.interval_s = std::exp(log_interval);
    return analyze_end(scene, stretches);
  }

  /// Every interval is analysed once, whatever limits ask for it.
  const CovarianceAnalysis& known(double log_interval) {
    auto found = known_.find(log_interval);
    if (found == known_.end()) {
      found = known_.emplace(log_interval, analysis_at(log_interval, stretches_)).first;
      if (config_.observer) config_.observer(std::exp(log_interval), found->second);
    }
    return found->second;
  }

  Sample sample(double log_interval) {
    return {log_interval, std::log(known(log_interval).true_m)};
  }

  /// Two neighbours with the limit between them, or both the same at an end of what is tried. The
  /// error may fall again where fixes come in step with the motion: every interval on the way to
  /// the lower one keeps the limit, as far as the steps see it. They are the same for all limits.
  std::pair<Sample, Sample> bracket(double log_limit) {
    const double log_shortest = std::log(config_.shortest_s);
    Sample below = sample(std::clamp(std::log(kFirstGuessS), log_shortest, log_longest_));
    Sample above = below;
    while (below.log_error > log_limit && below.log_interval > log_shortest) {
      above = below;
      below = sample(std::max(below.log_interval - std::log(kShorterBy), log_shortest));
    }
    if (below.log_error > log_limit) return {below, below};
    while (above.log_error <= log_limit && above.log_interval < log_longest_) {
      below = above;
      above = sample(std::min(above.log_interval + std::log(kLongerBy), log_longest_));
    }
    return {below, above};
  }

  /// Regula falsi with Illinois weights. @returns the last sample below the limit.
  Sample narrow(Sample below, Sample above, double log_limit) {
    double below_weight = 1.0;
    double above_weight = 1.0;
    for (int i = 0; i < kMostSecants; ++i) {
      const double low = below_weight * (below.log_error - log_limit);
      const double high = above_weight * (above.log_error - log_limit);
      const double width = above.log_interval - below.log_interval;
      if (width < config_.tolerance || -low < config_.tolerance * below_weight) break;
      // Halves where the two errors tell no slope.
      const double share = std::clamp(-low / (high - low), 0.0, 1.0);
      const Sample next =
          sample(below.log_interval + width * (std::isfinite(share) ? share : 0.5));
      if (next.log_error <= log_limit) {
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
    const CovarianceAnalysis& analysis = known(log_interval);
    answer.true_m = analysis.true_m;
    answer.claimed_m = analysis.claimed_m;
    answer.settled = analysis.settled;
    if (!config_.with_step_effect) return;
    // Fixes closer than half a step are the steps.
    if (std::exp(log_interval) <= 0.5 * config_.covariance_step_s) return;
    if (!fine_track_) {
      fine_track_ = error_track(scene_, 0.5 * config_.covariance_step_s);
      fine_stretches_.emplace(scene_, *fine_track_);
    }
    const double fine_m = analysis_at(log_interval, *fine_stretches_).true_m;
    answer.step_effect = std::abs(fine_m / analysis.true_m - 1.0);
  }

  const Scene& scene_;
  const IntervalConfig& config_;
  ErrorTrack track_;
  Stretches stretches_;
  std::optional<ErrorTrack> fine_track_{};
  std::optional<Stretches> fine_stretches_{};
  double log_longest_;
  std::map<double, CovarianceAnalysis> known_{};  // by log(interval)
};

}  // namespace

std::vector<Interval> solve_intervals(const Scene& scene, const std::vector<double>& limits_m,
                                      const IntervalConfig& config,
                                      const std::function<void(double fraction)>& progress) {
  validate(scene);
  validate(scene, limits_m, config);
  Solver solver(scene, config);
  std::vector<Interval> answers;
  for (const double limit_m : limits_m) {
    answers.push_back(solver.solve(limit_m));
    if (progress) {
      progress(static_cast<double>(answers.size()) / static_cast<double>(limits_m.size()));
    }
  }
  solver.add_free_inertial(answers);
  return answers;
}

}  // namespace leeway::sim
