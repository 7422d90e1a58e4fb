#include "sim/trials/confirmation.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/model/chi_square.hpp"

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

/// A campaign at one interval, beside the linear analysis of the same fixes.
struct TrialRun {
  CampaignResult campaign{};
  CovarianceAnalysis linear{};

  double rms_over_true() const { return campaign.rms_horizontal_m / linear.true_drms_m; }
  /// By the scene's metric, at the worst fix.
  double error_m() const { return linear.true_m * rms_over_true(); }
};

class Confirmer {
 public:
  Confirmer(const Scene& scene, const ErrorTrack& track, std::function<void(double)> progress)
      : scene_(scene), track_(track), progress_(std::move(progress)) {}

  Confirmation confirm(const Interval& answer) {
    const TrialRun first = run(answer.interval_s);
    Confirmation c;
    c.campaign = first.campaign;
    c.rms_over_true = first.rms_over_true();
    c.consistent = c.campaign.diverged == 0 &&
                   within_band(c.campaign.mean_nees, kErrorStates, scene_.trials) &&
                   within_band(2.0 * c.rms_over_true * c.rms_over_true, 2, scene_.trials);
    if (!c.consistent) c.interval_s = search(answer, first);
    return c;
  }

 private:
  TrialRun run(double interval_s) {
    scene_.gnss.interval_s = interval_s;
    TrialRun r;
    r.linear = analyze(scene_, track_);
    CampaignOptions options;
    options.score_last_s = r.linear.window_s;
    options.progress = [this](const CampaignProgress& p) { progress_(p.fraction); };
    r.campaign = campaign(scene_, options);
    return r;
  }

  /// Secants in log(error) over log(interval) between an interval that keeps the limit and one that
  /// does not. @returns the longest found that keeps it in the trials; nothing without one.
  std::optional<double> search(const Interval& answer, TrialRun here) {
    std::optional<double> kept;  // logarithms of intervals, s
    std::optional<double> lost;
    double log_s = std::log(answer.interval_s);
    double slope = 1.0;
    for (int i = 0; i < kMostSearches; ++i) {
      const double excess = std::log(here.error_m() / answer.limit_m);
      const bool diverges = here.campaign.diverged > 0 || !std::isfinite(excess);
      if (!diverges && std::abs(excess) < kSearchTolerance) return std::exp(log_s);
      (diverges || excess > 0.0 ? lost : kept) = log_s;
      // Of an error that is that of lost filters no secant can be drawn.
      double next = log_s - (diverges ? std::log(2.0) : std::clamp(excess / slope, -1.5, 1.5));
      if (kept && lost && !(next > *kept && next < *lost)) next = 0.5 * (*kept + *lost);
      if (std::exp(next) > 0.5 * scene_.duration_s) break;
      here = run(std::exp(next));
      const double moved = std::log(here.error_m() / answer.limit_m) - excess;
      slope = diverges ? 1.0 : std::clamp(moved / (next - log_s), 0.3, 5.0);
      log_s = next;
    }
    if (!kept) return {};
    return std::exp(*kept);
  }

  Scene scene_;
  const ErrorTrack& track_;
  std::function<void(double)> progress_;
};

}  // namespace

Confirmation confirm(const Scene& scene, const ErrorTrack& track, const Interval& answer,
                     const std::function<void(double fraction)>& progress) {
  return Confirmer(scene, track, progress).confirm(answer);
}

}  // namespace leeway::sim
