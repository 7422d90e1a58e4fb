#include "sim/cli/pages/campaign_fan.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "leeway/sim/tools/parallel.hpp"
#include "leeway/sim/trials/trial.hpp"
#include "sim/cli/output.hpp"
#include "sim/cli/pages/series_table.hpp"

namespace leeway::cli {
namespace {

constexpr int kMostTrials = 100;

/// By epoch; every trial adds its own row of each.
struct Spread {
  std::vector<double> t_s{};
  std::vector<std::vector<double>> error_h_m{};
  std::vector<std::vector<double>> claimed_r95_m{};
};

Spread spread_of(const sim::Scene& scene, int threads) {
  const sim::TrialPlan plan(scene, {}, threads);
  const auto trials = static_cast<std::size_t>(std::min(scene.trials, kMostTrials));
  std::vector<std::vector<sim::TrialEpoch>> epochs(trials);
  Progress progress("fan");
  sim::parallel_for(
      trials,
      [&](std::size_t k) {
        sim::run_trial(plan, scene.first_seed + k,
                       [&epochs, k](const sim::TrialEpoch& e) { epochs[k].push_back(e); });
      },
      [&](std::size_t done) {
        progress.show(static_cast<double>(done) / static_cast<double>(trials));
      },
      threads);
  Spread spread;
  spread.error_h_m.resize(plan.fixes().size());
  spread.claimed_r95_m.resize(plan.fixes().size());
  for (const auto& trial : epochs) {
    // A trial that is no longer finite ends early.
    for (std::size_t i = 0; i < trial.size(); ++i) {
      if (i == spread.t_s.size()) spread.t_s.push_back(trial[i].t_s);
      spread.error_h_m[i].push_back(trial[i].error_h_m);
      spread.claimed_r95_m[i].push_back(trial[i].claimed_r95_m);
    }
  }
  return spread;
}

/// Between the neighbours in a sorted list.
double percentile_of(const std::vector<double>& sorted, double fraction) {
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], at - static_cast<double>(below));
}

}  // namespace

Json campaign_fan(const sim::Scene& scene, int threads) {
  Spread spread = spread_of(scene, threads);
  SeriesTable fan(
      {"t_s", "p2_5_m", "p25_m", "p50_m", "p75_m", "p95_m", "p97_5_m", "claimed_r95_m"});
  for (std::size_t i = 0; i < spread.t_s.size(); ++i) {
    std::vector<double>& errors = spread.error_h_m[i];
    std::vector<double>& claims = spread.claimed_r95_m[i];
    std::sort(errors.begin(), errors.end());
    std::sort(claims.begin(), claims.end());
    std::vector<double> row{spread.t_s[i]};
    for (const double fraction : {0.025, 0.25, 0.5, 0.75, 0.95, 0.975}) {
      row.push_back(percentile_of(errors, fraction));
    }
    row.push_back(percentile_of(claims, 0.5));
    fan.add(row);
  }
  return {{"fan", fan.json()}};
}

}  // namespace leeway::cli
