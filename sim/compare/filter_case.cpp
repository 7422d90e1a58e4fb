#include "sim/compare/filter_case.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <tuple>
#include <utility>

#include "leeway/sim/tools/parallel.hpp"
#include "sim/compare/variant_run.hpp"
#include "sim/trials/campaign_sums.hpp"
#include "sim/trials/recorded_trial.hpp"

namespace leeway::sim {
namespace {

/// The trials of one seed as cases are given them, each made when it is first asked for.
class GivenTrials {
 public:
  explicit GivenTrials(std::uint64_t seed) : seed_(seed) {}

  /// Lives as long as this.
  const RecordedTrial& to(const FilterCase& one) {
    const Key key{one.plan, one.variant.imu_divider, one.knows_latency};
    const auto found = trials_.find(key);
    return found != trials_.end() ? found->second : trials_.emplace(key, made(one)).first->second;
  }

 private:
  using Key = std::tuple<const TrialPlan*, int, bool>;

  RecordedTrial made(const FilterCase& one) {
    FilterCase plainer = one;
    if (one.variant.imu_divider > 1) {
      plainer.variant.imu_divider = 1;
      return at_lower_rate(to(plainer), one.variant.imu_divider);
    }
    if (!one.knows_latency) {
      plainer.knows_latency = true;
      return valid_at_arrival(to(plainer));
    }
    return record_trial(*one.plan, seed_);
  }

  std::uint64_t seed_;
  std::map<Key, RecordedTrial> trials_{};
};

double run_case(const FilterCase& one, const RecordedTrial& trial,
                const ScoreObserver& observer = {}) {
  TrialStart start = trial.start;
  const BiasStates& biases = one.config.biases;
  for (const auto& [state, row] :
       {std::pair{biases.accelerometer, kBa}, std::pair{biases.gyro, kBg}}) {
    if (state == BiasState::kNone) start.P.block<3, 3>(row, row).setZero();
  }
  return run_variant(one.variant, one.config, start, trial, observer);
}

CaseRun scored_run(const FilterCase& one, const RecordedTrial& trial, std::uint64_t seed) {
  CaseRun run;
  run.score.seed = seed;
  run_case(one, trial,
           [&run](const Estimate& truth, const Estimate& estimate, const ErrorMatrix* P) {
             if (run.score.finite) score_epoch(run.score, truth, estimate, P);
             run.error_n_m.emplace_back(position_error_n_m(truth, estimate));
             run.course_rad.push_back(course_over_ground_rad(truth.nav));
           });
  if (!run.score.finite) run.score.diverged = true;
  return run;
}

}  // namespace

std::vector<std::vector<CaseRun>> run_cases(const std::vector<FilterCase>& cases, int threads,
                                            const std::function<void(double)>& progress) {
  if (cases.empty()) return {};
  const Scene& scene = cases.front().plan->scene();
  const auto trials = static_cast<std::size_t>(scene.trials);
  std::vector<std::vector<CaseRun>> runs(cases.size(), std::vector<CaseRun>(trials));
  parallel_for(
      trials,
      [&](std::size_t k) {
        const std::uint64_t seed = scene.first_seed + k;
        GivenTrials given(seed);
        for (std::size_t c = 0; c < cases.size(); ++c) {
          runs[c][k] = scored_run(cases[c], given.to(cases[c]), seed);
        }
      },
      [&](std::size_t done) {
        if (progress) progress(static_cast<double>(done) / static_cast<double>(trials));
      },
      threads);
  return runs;
}

std::vector<std::vector<double>> times_ns_per_s(const std::vector<FilterCase>& cases, int rounds,
                                                const std::function<void(double)>& progress) {
  std::vector<std::vector<double>> times(cases.size());
  if (cases.empty()) return times;
  GivenTrials given(cases.front().plan->scene().first_seed);
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t c = 0; c < cases.size(); ++c) {
      const RecordedTrial& trial = given.to(cases[c]);
      times[c].push_back(1e9 * run_case(cases[c], trial) / to_seconds(trial.imu.back().time));
    }
    if (progress) progress(static_cast<double>(round + 1) / rounds);
  }
  return times;
}

Cost cost_of(std::vector<double> ns_per_s) {
  std::sort(ns_per_s.begin(), ns_per_s.end());
  const std::size_t half = ns_per_s.size() / 2;
  const double median =
      ns_per_s.size() % 2 == 1 ? ns_per_s[half] : 0.5 * (ns_per_s[half - 1] + ns_per_s[half]);
  return {median, ns_per_s.front(), ns_per_s.back()};
}

std::vector<double> sizes_m(ErrorMetric metric, const std::vector<CaseRun>& runs) {
  std::vector<double> sizes;
  for (const CaseRun& run : runs) {
    if (!run.score.finite) continue;
    for (std::size_t i = 0; i < run.error_n_m.size(); ++i) {
      sizes.push_back(size_of_error_m(metric, run.error_n_m[i], run.course_rad[i]));
    }
  }
  return sizes;
}

CampaignResult figures_of(const std::vector<CaseRun>& runs) {
  CampaignSums sums;
  for (const CaseRun& run : runs) sums.add(run.score);
  return result_of(sums);
}

}  // namespace leeway::sim
