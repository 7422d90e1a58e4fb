#include "sim/trials/confirmation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "leeway/model/chi_square.hpp"
#include "leeway/model/error_metric.hpp"
#include "leeway/sim/tools/quantile.hpp"
#include "leeway/sim/trials/trial.hpp"
#include "sim/trials/campaign_sums.hpp"
#include "sim/trials/shared_trials.hpp"

namespace leeway::sim {
namespace {

constexpr double kRareProbability = 1e-3;  // of an honest filter found inconsistent
constexpr int kMostSearches = 7;
constexpr double kSearchTolerance = 0.02;  // of the limit; about the scatter of 200 trials

/// Whether the mean of chi-square values, one a trial, is one that an honest filter may have.
bool within_band(double mean, int dof_each, std::int64_t trials) {
  const int dof = dof_each * static_cast<int>(trials);
  const auto count = static_cast<double>(trials);
  return mean * count > chi_square_threshold(1.0 - 0.5 * kRareProbability, dof) &&
         mean * count < chi_square_threshold(0.5 * kRareProbability, dof);
}

/// The linear analysis of a scene, and its error by the scene's metric before every fix.
struct LinearRun {
  CovarianceAnalysis analysis{};
  std::vector<double> errors_m{};
};

LinearRun linear_run(const Scene& scene, const ErrorTrack& track) {
  LinearRun run;
  CovarianceConfig config;
  config.observer = [&](const CovariancePoint& point) {
    if (point.moment != CovariancePoint::Moment::kBeforeFix) return;
    const Eigen::Matrix3d P_n_m2 = ned_covariance(point.r_e_m, point.truth.block<3, 3>(kDr, kDr));
    run.errors_m.push_back(error_by_metric_m(scene, track, point.t_s, P_n_m2));
  };
  run.analysis = analyze(scene, track, config);
  return run;
}

/// Those of north, east, down that count.
struct Axes {
  Eigen::Index first{0};
  Eigen::Index count{2};
};

/// The axes that a metric measures; of along and across the track the horizontal ones.
Axes axes_of(ErrorMetric metric) {
  if (metric == ErrorMetric::kVertical95) return {2, 1};
  return {0, metric == ErrorMetric::k3d ? 3 : 2};
}

/// Of all trials but one; none is left out where `without` is none of them.
double rms_over_linear(const std::vector<SharedTrial>& trials, std::size_t without,
                       const CovarianceAnalysis& linear, Axes axes = {}) {
  double sum_m2 = 0.0;
  double epochs = 0.0;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    if (k == without || !trials[k].score.finite) continue;
    sum_m2 += trials[k].score.error_sq_n_m2.segment(axes.first, axes.count).sum();
    epochs += static_cast<double>(trials[k].score.epochs);
  }
  return std::sqrt(sum_m2 / epochs) / linear.true_rms_n_m.segment(axes.first, axes.count).norm();
}

double quantile_over_linear(const std::vector<SharedTrial>& trials, std::size_t without,
                            double probability) {
  std::vector<double> all;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    if (k == without) continue;
    all.insert(all.end(), trials[k].of_fixes.begin(), trials[k].of_fixes.end());
  }
  return quantile_of(std::move(all), probability);
}

/// Trials at one interval, beside the linear analysis of the same fixes.
struct TrialRun {
  CampaignResult campaign{};
  CovarianceAnalysis linear{};
  double rms_over_true{};
  double rms_of_axes{};  ///< the same, of the metric's axes
  double error_over_true{};
  double scatter{};

  /// Of the worst fix, over what is allowed there.
  double excess() const { return std::log(linear.true_m / linear.allowed_m * error_over_true); }
  bool diverges() const { return campaign.diverged > 0 || !std::isfinite(error_over_true); }

  /// How many sigmas of its scatter the ratio is beyond kAgreement; below 0: within it.
  double excess_sigmas() const {
    const double excess = std::abs(std::log(error_over_true)) - std::log(kAgreement);
    return excess / std::max(scatter, 1e-6);
  }
};

/// Source of the scatter: the jackknife, Efron and Tibshirani (1993) (11.5).
TrialRun summed(const std::vector<SharedTrial>& trials, const CovarianceAnalysis& linear,
                ErrorMetric metric) {
  TrialRun run{.linear = linear};
  CampaignSums sums;
  for (const SharedTrial& trial : trials) sums.add(trial.score);
  run.campaign = result_of(sums);
  const std::size_t n = trials.size();
  const auto ratio = [&](std::size_t without) {
    const double probability = quantile_probability(metric);
    if (probability > 0.0) return quantile_over_linear(trials, without, probability);
    return rms_over_linear(trials, without, linear, axes_of(metric));
  };
  run.rms_over_true = rms_over_linear(trials, n, linear);
  run.rms_of_axes = rms_over_linear(trials, n, linear, axes_of(metric));
  run.error_over_true = ratio(n);
  double sum_sq = 0.0;
  for (std::size_t k = 0; k < n; ++k) sum_sq += std::pow(ratio(k) - run.error_over_true, 2);
  const auto count = static_cast<double>(n);
  run.scatter = std::sqrt((count - 1.0) / count * sum_sq) / run.error_over_true;
  return run;
}

/// The trials at one interval, as many as have been run.
struct IntervalTrials {
  LinearRun linear{};
  TrialPlan plan;
  std::vector<SharedTrial> trials{};
};

class Confirmer {
 public:
  Confirmer(const Scene& scene, const ErrorTrack& track, const Ranks& ranks,
            std::function<void(double)> progress)
      : scene_(scene), track_(track), ranks_(ranks), progress_(std::move(progress)) {}

  Confirmation confirm(const Interval& answer) {
    scene_.limit.allow(answer.allowed());
    return judged(answer, run(answer.interval_s));
  }

  Confirmation check(const Interval& answer) {
    scene_.limit.allow(answer.allowed());
    scene_.trials = kFewestTrials;
    IntervalTrials trials = planned(answer.interval_s);
    TrialRun first = run_all(trials);
    while (!first.diverges() && std::abs(first.excess_sigmas()) < kClearSigmas &&
           scene_.trials < kMostTrials) {
      scene_.trials *= 2;
      first = run_all(trials);
    }
    return judged(answer, first);
  }

 private:
  static constexpr double kClearSigmas = 2.0;

  Confirmation judged(const Interval& answer, const TrialRun& first) {
    Confirmation c;
    c.campaign = first.campaign;
    c.rms_over_true = first.rms_over_true;
    c.error_over_true = first.error_over_true;
    c.scatter = first.scatter;
    c.agrees = !first.diverges() && first.excess_sigmas() < kClearSigmas;
    const auto axes = static_cast<int>(axes_of(scene_.limit.metric).count);
    c.consistent = c.campaign.diverged == 0 &&
                   within_band(c.campaign.mean_nees, kErrorStates, scene_.trials) &&
                   within_band(axes * first.rms_of_axes * first.rms_of_axes, axes, scene_.trials);
    if (!c.agrees) c.interval_s = search(answer, first);
    c.trials_run = trials_run_;
    return c;
  }

  IntervalTrials planned(double interval_s) {
    scene_.gnss.interval_s = interval_s;
    LinearRun linear = linear_run(scene_, track_);
    const double scored_s = linear.analysis.window_s;
    return {std::move(linear), TrialPlan(scene_, scored_s)};
  }

  /// Runs those of the scene's trials that have not been run, and takes all.
  TrialRun run_all(IntervalTrials& at) {
    const auto over_linear = [&](std::size_t k, const TrialEpoch& epoch) -> std::optional<double> {
      if (k >= at.linear.errors_m.size() || !at.plan.fixes()[k].scored) return {};
      return size_m(epoch) / at.linear.errors_m[k];
    };
    const std::uint64_t done = at.trials.size();
    const SeedRange rest{scene_.first_seed + done,
                         static_cast<std::uint64_t>(scene_.trials) - done};
    std::ranges::move(shared_trials(at.plan, rest, over_linear, ranks_, progress_),
                      std::back_inserter(at.trials));
    trials_run_ += static_cast<int>(rest.count);
    return summed(at.trials, at.linear.analysis, scene_.limit.metric);
  }

  TrialRun run(double interval_s) {
    IntervalTrials trials = planned(interval_s);
    return run_all(trials);
  }

  double size_m(const TrialEpoch& epoch) const {
    if (!epoch.error_n_m.allFinite()) return std::numeric_limits<double>::infinity();
    const ErrorMetric metric = scene_.limit.metric;
    const double course_rad = asks_for_course(metric) ? track_.path().course_rad(epoch.t_s) : 0.0;
    return size_of_error_m(metric, epoch.error_n_m, course_rad);
  }

  /// Secants in log(error) over log(interval) between an interval that keeps the limit and one that
  /// does not. @returns the longest found that keeps it in the trials; nothing without one.
  std::optional<double> search(const Interval& answer, TrialRun here) {
    std::optional<double> kept;  // logarithms of intervals, s
    std::optional<double> lost;
    double log_s = std::log(answer.interval_s);
    double slope = 1.0;
    for (int i = 0; i < kMostSearches; ++i) {
      const double excess = here.excess();
      const bool diverges = here.diverges();
      if (!diverges && std::abs(excess) < kSearchTolerance) return std::exp(log_s);
      (diverges || excess > 0.0 ? lost : kept) = log_s;
      // Of an error that is that of lost filters no secant can be drawn.
      double next = log_s - (diverges ? std::log(2.0) : std::clamp(excess / slope, -1.5, 1.5));
      if (kept && lost && !(next > *kept && next < *lost)) next = 0.5 * (*kept + *lost);
      if (std::exp(next) > longest_interval_s(scene_)) break;
      here = run(std::exp(next));
      const double moved = here.excess() - excess;
      slope = diverges ? 1.0 : std::clamp(moved / (next - log_s), 0.3, 5.0);
      log_s = next;
    }
    if (!kept) return {};
    return std::exp(*kept);
  }

  Scene scene_;
  const ErrorTrack& track_;
  const Ranks& ranks_;
  std::function<void(double)> progress_;
  int trials_run_{0};
};

}  // namespace

Confirmation confirm(const Scene& scene, const ErrorTrack& track, const Interval& answer,
                     const Ranks& ranks, const std::function<void(double fraction)>& progress) {
  return Confirmer(scene, track, ranks, progress).confirm(answer);
}

Confirmation check(const Scene& scene, const ErrorTrack& track, const Interval& answer,
                   const Ranks& ranks, const std::function<void(double fraction)>& progress) {
  return Confirmer(scene, track, ranks, progress).check(answer);
}

}  // namespace leeway::sim
