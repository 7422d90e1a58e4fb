#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "leeway/model/process_noise.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "sim/reduce/reduction_parts.hpp"
#include "sim/trials/campaign_sums.hpp"
#include "sim/trials/trial_score.hpp"

namespace leeway::sim {
namespace {

Variant variant_of(const FilterModel& model) {
  return {.strapdown = model.config.strapdown,
          .imu_divider = model.imu_divider,
          .covariance_interval_s = model.config.covariance_interval_s,
          .precision = model.precision};
}

/// A trial as the filters of the models are given it, made when it is first asked for.
class GivenTrials {
 public:
  explicit GivenTrials(std::uint64_t seed) : seed_(seed) {}

  const RecordedTrial& to(const TrialPlan& plan, const FilterModel& model) {
    const Key key{&plan, model.imu_divider, model.knows_latency};
    for (const auto& [made, trial] : trials_) {
      if (made == key) return *trial;
    }
    return *trials_.emplace_back(key, std::make_unique<RecordedTrial>(make(plan, model))).second;
  }

 private:
  using Key = std::tuple<const TrialPlan*, int, bool>;

  RecordedTrial make(const TrialPlan& plan, const FilterModel& model) {
    if (model.imu_divider > 1) {
      FilterModel at_full_rate = model;
      at_full_rate.imu_divider = 1;
      return at_lower_rate(to(plan, at_full_rate), model.imu_divider);
    }
    if (!model.knows_latency) {
      FilterModel knowing = model;
      knowing.knows_latency = true;
      return valid_at_arrival(to(plan, knowing));
    }
    return record_trial(plan, seed_);
  }

  std::uint64_t seed_;
  std::vector<std::pair<Key, std::unique_ptr<RecordedTrial>>> trials_{};
};

/// Biases that are no states are certain.
TrialStart given_start(const RecordedTrial& trial, const BiasStates& biases) {
  TrialStart start = trial.start;
  for (const auto& [state, row] :
       {std::pair{biases.accelerometer, kBa}, std::pair{biases.gyro, kBg}}) {
    if (state == BiasState::kNone) start.P.block<3, 3>(row, row).setZero();
  }
  return start;
}

struct CaseRun {
  TrialScore score{};
  std::vector<Eigen::Vector2d> error_ne_m{};
};

CaseRun run_case(const FilterModel& model, const RecordedTrial& trial, std::uint64_t seed) {
  CaseRun run;
  run.score.seed = seed;
  const auto score = [&run](const Estimate& truth, const Estimate& estimate, const ErrorMatrix* P) {
    if (run.score.finite) score_epoch(run.score, truth, estimate, P);
    run.error_ne_m.emplace_back(position_error_n_m(truth, estimate).head<2>());
  };
  make_variant_run(variant_of(model), model.config, given_start(trial, model.config.biases))
      ->replay(trial, score);
  if (!run.score.finite) run.score.diverged = true;
  return run;
}

double empirical_error_m(HorizontalMetric metric, const std::vector<CaseRun>& runs) {
  std::vector<double> radii_m;
  Eigen::Vector2d sum_sq_m2 = Eigen::Vector2d::Zero();
  for (const CaseRun& run : runs) {
    if (!run.score.finite) continue;
    for (const Eigen::Vector2d& error : run.error_ne_m) {
      radii_m.push_back(error.norm());
      sum_sq_m2 += error.cwiseAbs2();
    }
  }
  sum_sq_m2 /= static_cast<double>(radii_m.size());
  if (metric == HorizontalMetric::kR95) return r95_of(std::move(radii_m));
  return std::sqrt(metric == HorizontalMetric::kDrms ? sum_sq_m2.sum() : sum_sq_m2.maxCoeff());
}

double difference_m(const std::vector<CaseRun>& runs, const std::vector<CaseRun>& others) {
  double sum_m2 = 0.0;
  std::size_t epochs = 0;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    if (!runs[k].score.finite || !others[k].score.finite) continue;
    epochs += runs[k].error_ne_m.size();
    for (std::size_t i = 0; i < runs[k].error_ne_m.size(); ++i) {
      sum_m2 += (runs[k].error_ne_m[i] - others[k].error_ne_m[i]).squaredNorm();
    }
  }
  return std::sqrt(sum_m2 / static_cast<double>(epochs));
}

MeasuredAccuracy case_summary(HorizontalMetric metric, const std::vector<CaseRun>& runs,
                              const std::vector<CaseRun>& full) {
  CampaignSums sums;
  for (const CaseRun& run : runs) sums.add(run.score);
  return {empirical_error_m(metric, runs), difference_m(runs, full), result_of(sums)};
}

void take_away(TriadErrorModel& triad, bool scales, bool misalignments) {
  // Not zero: a spread that is drawn leaves the random numbers after it as they were.
  constexpr double kNothing = 1e-300;
  if (scales) {
    triad.M.diagonal().setOnes();
    if (triad.scale_sigma > 0.0) triad.scale_sigma = kNothing;
  }
  if (misalignments) {
    triad.M = Eigen::Matrix3d(triad.M.diagonal().asDiagonal());
    if (triad.misalignment_sigma_rad > 0.0) triad.misalignment_sigma_rad = kNothing;
  }
}

}  // namespace

Scene without_sources(Scene scene, const std::vector<ErrorSource>& sources) {
  const auto has = [&sources](ErrorSource source) {
    return std::find(sources.begin(), sources.end(), source) != sources.end();
  };
  take_away(scene.imu.accelerometer, has(ErrorSource::kAccelerometerScale),
            has(ErrorSource::kAccelerometerMisalignment));
  take_away(scene.imu.gyro, has(ErrorSource::kGyroScale), has(ErrorSource::kGyroMisalignment));
  if (has(ErrorSource::kGyroGSensitivity)) {
    scene.imu.G_g_radps_per_mps2.setZero();
    if (scene.imu.G_g_sigma_radps_per_mps2 > 0.0) scene.imu.G_g_sigma_radps_per_mps2 = 1e-300;
  }
  return scene;
}

std::vector<MeasuredAccuracy> measured(const std::vector<ReductionCase>& cases, int threads,
                                       const std::function<void(double)>& progress) {
  const Scene& scene = cases.front().plan->scene();
  const auto trials = static_cast<std::size_t>(scene.trials);
  std::vector<std::vector<CaseRun>> runs(cases.size(), std::vector<CaseRun>(trials));
  parallel_for(
      trials,
      [&](std::size_t k) {
        const std::uint64_t seed = scene.first_seed + k;
        GivenTrials given(seed);
        for (std::size_t c = 0; c < cases.size(); ++c) {
          const ReductionCase& one = cases[c];
          runs[c][k] = run_case(one.model, given.to(*one.plan, one.model), seed);
        }
      },
      [&](std::size_t done) {
        if (progress) progress(static_cast<double>(done) / static_cast<double>(trials));
      },
      threads);
  std::vector<MeasuredAccuracy> result;
  for (const auto& of_case : runs) {
    result.push_back(case_summary(scene.limit.metric, of_case, runs.front()));
  }
  return result;
}

ModelCosts model_costs(const TrialPlan& plan, const std::vector<FilterModel>& models, int rounds,
                       const std::function<void(double)>& progress) {
  GivenTrials given(plan.scene().first_seed);
  const auto timed = [&](const FilterModel& model, std::size_t place) {
    const RecordedTrial& trial = given.to(plan, model);
    const TrialStart start = given_start(trial, model.config.biases);
    return timed_ns_per_s(variant_of(model), model.config, start, trial, place);
  };
  std::vector<std::vector<double>> savings(models.size());
  std::vector<TimedRun> runs;
  for (std::size_t m = 0; m < models.size(); ++m) {
    runs.emplace_back([&, m](std::size_t place) {
      // The first model beside each: what slows the machine slows both.
      const double first_ns_per_s = timed(models.front(), place);
      const double ns_per_s = timed(models[m], place);
      savings[m].push_back(first_ns_per_s - ns_per_s);
      return ns_per_s;
    });
  }
  ModelCosts result{interleaved_costs(runs, rounds, progress), {}};
  for (std::vector<double>& of_model : savings) {
    result.savings.push_back(cost_of(std::move(of_model)));
  }
  return result;
}

}  // namespace leeway::sim
