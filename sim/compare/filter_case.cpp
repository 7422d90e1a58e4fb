#include "sim/compare/filter_case.hpp"

#include "leeway/model/process_noise.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "sim/trials/campaign_sums.hpp"

namespace leeway::sim {
namespace {

CaseRun scored_run(const FilterCase& one, const RecordedTrial& trial, std::uint64_t seed) {
  CaseRun run;
  run.score.seed = seed;
  const auto score = [&run](const Estimate& truth, const Estimate& estimate, const ErrorMatrix* P) {
    if (run.score.finite) score_epoch(run.score, truth, estimate, P);
    run.error_ne_m.emplace_back(position_error_n_m(truth, estimate).head<2>());
  };
  run_case(one, trial, score);
  if (!run.score.finite) run.score.diverged = true;
  return run;
}

}  // namespace

const RecordedTrial& GivenTrials::to(const FilterCase& one) {
  const Key key{one.plan, one.variant.imu_divider, one.knows_latency};
  for (const auto& [made, trial] : trials_) {
    if (made == key) return *trial;
  }
  return *trials_.emplace_back(key, std::make_unique<RecordedTrial>(made(one))).second;
}

RecordedTrial GivenTrials::made(const FilterCase& one) {
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

double run_case(const FilterCase& one, const RecordedTrial& trial, const ScoreObserver& observer) {
  TrialStart start = trial.start;
  const BiasStates& biases = one.config.biases;
  for (const auto& [state, row] :
       {std::pair{biases.accelerometer, kBa}, std::pair{biases.gyro, kBg}}) {
    if (state == BiasState::kNone) start.P.block<3, 3>(row, row).setZero();
  }
  return run_variant(one.variant, one.config, start, trial, observer);
}

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

std::vector<double> radial_errors_m(const std::vector<CaseRun>& runs) {
  std::vector<double> radii_m;
  for (const CaseRun& run : runs) {
    if (!run.score.finite) continue;
    for (const Eigen::Vector2d& error_m : run.error_ne_m) radii_m.push_back(error_m.norm());
  }
  return radii_m;
}

CampaignResult figures_of(const std::vector<CaseRun>& runs) {
  CampaignSums sums;
  for (const CaseRun& run : runs) sums.add(run.score);
  return result_of(sums);
}

}  // namespace leeway::sim
