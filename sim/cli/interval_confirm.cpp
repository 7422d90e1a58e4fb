#include "interval_confirm.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "leeway/filters/chi_square.hpp"
#include "leeway/sim/covariance_analysis.hpp"
#include "output.hpp"

namespace leeway::cli {
namespace {

constexpr double kRareProbability = 1e-3;  // of an honest filter found inconsistent
constexpr int kMostSearches = 5;
constexpr double kSearchTolerance = 0.02;  // of the limit; about the scatter of 200 trials

/// Whether the mean of chi-square values, one a trial, is one that an honest filter may have.
bool within_band(double mean, int dof_each, std::int64_t trials) {
  const int dof = dof_each * static_cast<int>(trials);
  const auto count = static_cast<double>(trials);
  return mean * count > chi_square_threshold(1.0 - 0.5 * kRareProbability, dof) &&
         mean * count < chi_square_threshold(0.5 * kRareProbability, dof);
}

/// A campaign at one interval, beside the linear analysis of the same fixes.
struct Run {
  sim::CampaignResult campaign{};
  sim::CovarianceAnalysis linear{};

  double rms_over_true() const { return campaign.rms_horizontal_m / linear.true_drms_m; }
  /// By the scene's metric, at the worst fix.
  double error_m() const { return linear.true_m * rms_over_true(); }
};

class Confirmer {
 public:
  Confirmer(const sim::Scene& scene, const sim::ErrorTrack& track, int trials, Progress& progress)
      : scene_(scene), track_(track), progress_(progress) {
    scene_.trials = trials;
  }

  Confirmation confirm(const sim::Interval& answer) {
    const Run first = run(answer.interval_s);
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
  Run run(double interval_s) {
    scene_.gnss.interval_s = interval_s;
    Run r;
    r.linear = sim::analyze(scene_, track_);
    sim::CampaignOptions options;
    options.score_last_s = r.linear.window_s;
    options.progress = [this](const sim::CampaignProgress& p) { progress_.show(p.fraction); };
    r.campaign = sim::campaign(scene_, options);
    return r;
  }

  /// Secants in log(error) over log(interval). @returns nothing when they do not close in.
  std::optional<double> search(const sim::Interval& answer, const Run& first) {
    if (std::abs(first.error_m() / answer.limit_m - 1.0) < kSearchTolerance) {
      return answer.interval_s;
    }
    double slope = 1.0;
    double before_log_s = std::log(answer.interval_s);
    double before_log_m = std::log(first.error_m());
    for (int i = 0; i < kMostSearches; ++i) {
      const double step = (std::log(answer.limit_m) - before_log_m) / slope;
      const double log_s = before_log_s + std::clamp(step, -1.5, 1.5);
      if (std::exp(log_s) > 0.5 * scene_.duration_s || !std::isfinite(log_s)) return {};
      const double error_m = run(std::exp(log_s)).error_m();
      if (std::abs(error_m / answer.limit_m - 1.0) < kSearchTolerance) return std::exp(log_s);
      slope = std::clamp((std::log(error_m) - before_log_m) / (log_s - before_log_s), 0.3, 5.0);
      before_log_s = log_s;
      before_log_m = std::log(error_m);
    }
    return {};
  }

  sim::Scene scene_;
  const sim::ErrorTrack& track_;
  Progress& progress_;
};

}  // namespace

void confirm(std::vector<SolvedImu>& solved, int trials, const std::vector<double>& limits_m) {
  const auto is_asked = [&limits_m](double limit_m) {
    return limits_m.empty() ||
           std::find(limits_m.begin(), limits_m.end(), limit_m) != limits_m.end();
  };
  for (SolvedImu& imu : solved) {
    const sim::ErrorTrack track = sim::error_track(imu.scene);
    for (const sim::Interval& answer : imu.intervals) {
      imu.confirmations.emplace_back();
      if (std::isnan(answer.interval_s) || !is_asked(answer.limit_m)) continue;
      Progress progress(
          fmt::format("confirm {} at {:.1f} s", imu.scene.imu_name, answer.interval_s));
      imu.confirmations.back() = Confirmer(imu.scene, track, trials, progress).confirm(answer);
    }
  }
}

}  // namespace leeway::cli
