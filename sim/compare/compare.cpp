#include "leeway/sim/compare/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "leeway/earth/error.hpp"
#include "leeway/sim/compare/pareto.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "leeway/sim/trials/trial.hpp"
#include "sim/compare/variant_cost.hpp"
#include "sim/compare/variant_run.hpp"
#include "sim/trials/campaign_sums.hpp"
#include "sim/trials/recorded_trial.hpp"

namespace leeway::sim {
namespace {

constexpr std::array kDividers{1, 2, 5};
constexpr std::size_t kSurvivors = 3;
constexpr double kSurvives = 1.01;  // of the default's error

/// A trial at every IMU rate, made when it is first asked for.
class Recordings {
 public:
  Recordings(const TrialPlan& plan, std::uint64_t seed) : full_(record_trial(plan, seed)) {}

  const RecordedTrial& at(int divider) {
    if (divider == 1) return full_;
    for (const auto& [n, slower] : slower_) {
      if (n == divider) return slower;
    }
    return slower_.emplace_back(divider, at_lower_rate(full_, divider)).second;
  }

 private:
  RecordedTrial full_;
  std::vector<std::pair<int, RecordedTrial>> slower_{};
};

/// One variant in one trial.
struct ContenderRun {
  TrialScore score{};
  std::vector<double> horizontal_m{};
};

ContenderRun scored_run(const Variant& variant, const EkfConfig& believed,
                        const RecordedTrial& trial, std::uint64_t seed) {
  ContenderRun run;
  run.score.seed = seed;
  const auto score = [&run](const Estimate& truth, const Estimate& estimate, const ErrorMatrix* P) {
    if (!run.score.finite) return;
    score_epoch(run.score, truth, estimate, P);
    if (!run.score.finite) return;
    run.horizontal_m.push_back(position_error_n_m(truth, estimate).head<2>().norm());
  };
  make_variant_run(variant, believed, trial.start)->replay(trial, score);
  if (!run.score.finite) run.score.diverged = true;
  return run;
}

Accuracy summary(const Variant& variant, const std::vector<ContenderRun>& runs) {
  CampaignSums sums;
  std::vector<double> horizontal_m;
  for (const ContenderRun& run : runs) {
    sums.add(run.score);
    if (!run.score.finite) continue;
    horizontal_m.insert(horizontal_m.end(), run.horizontal_m.begin(), run.horizontal_m.end());
  }
  return {result_of(sums), r95_of(std::move(horizontal_m)), variant.estimator != Estimator::kReset};
}

std::vector<Accuracy> accuracy_in(const TrialPlan& plan, const std::vector<Variant>& variants,
                                  int threads, const std::function<void(double)>& progress) {
  const auto trials = static_cast<std::size_t>(plan.scene().trials);
  std::vector<std::vector<ContenderRun>> runs(variants.size(), std::vector<ContenderRun>(trials));
  parallel_for(
      trials,
      [&](std::size_t k) {
        const std::uint64_t seed = plan.scene().first_seed + k;
        Recordings recordings(plan, seed);
        for (std::size_t v = 0; v < variants.size(); ++v) {
          runs[v][k] = scored_run(variants[v], plan.scene().filter,
                                  recordings.at(variants[v].imu_divider), seed);
        }
      },
      [&](std::size_t done) {
        if (progress) progress(static_cast<double>(done) / static_cast<double>(trials));
      },
      threads);
  std::vector<Accuracy> result;
  for (std::size_t v = 0; v < variants.size(); ++v) result.push_back(summary(variants[v], runs[v]));
  return result;
}

std::vector<Cost> costs_of(const TrialPlan& plan, const std::vector<Variant>& variants, int rounds,
                           const std::function<void(double)>& progress) {
  Recordings recordings(plan, plan.scene().first_seed);
  std::vector<TimedRun> runs;
  for (const Variant& variant : variants) {
    runs.emplace_back([&plan, &recordings, variant](std::size_t place) {
      const RecordedTrial& trial = recordings.at(variant.imu_divider);
      return timed_ns_per_s(variant, plan.scene().filter, trial.start, trial, place);
    });
  }
  return interleaved_costs(runs, rounds, progress);
}

std::vector<int> fitting_dividers(const TrialPlan& plan) {
  std::vector<int> dividers;
  for (const int n : kDividers) {
    // The scene's own rate is what the plan was made for.
    if (n == 1 || fits(plan, n)) dividers.push_back(n);
  }
  return dividers;
}

/// The cheapest of a list that err no more than the default does, by kSurvives.
std::vector<Variant> survivors(const std::vector<Variant>& list,
                               const std::vector<Compared>& compared, double imu_rate_hz) {
  const auto found = [&](const Variant& variant) -> const Compared& {
    return *std::find_if(compared.begin(), compared.end(), [&](const Compared& c) {
      return c.name == variant_name(variant, imu_rate_hz);
    });
  };
  const double limit_m = kSurvives * found(Variant{}).accuracy.figures.rms_horizontal_m;
  std::vector<const Compared*> sorted;
  for (const Variant& variant : list) {
    const Compared& c = found(variant);
    const Consistency consistency = consistency_of(c.accuracy);
    const bool is_lost =
        consistency == Consistency::kDiverged || consistency == Consistency::kNotFinite;
    if (!is_lost && c.accuracy.figures.rms_horizontal_m <= limit_m) sorted.push_back(&c);
  }
  std::sort(sorted.begin(), sorted.end(), [](const Compared* a, const Compared* b) {
    return a->cost.median_ns_per_s < b->cost.median_ns_per_s;
  });
  std::vector<Variant> result;
  for (const Compared* c : sorted) {
    if (result.size() < kSurvivors) result.push_back(c->variant);
  }
  return result;
}

std::vector<Variant> combinations(const std::vector<Compared>& compared,
                                  const std::vector<int>& dividers, double imu_rate_hz) {
  std::set<std::string> names;
  for (const Compared& c : compared) names.insert(c.name);
  std::vector<Variant> result;
  const auto covariances = survivors(covariance_variants(), compared, imu_rate_hz);
  for (const Variant& s : survivors(strapdown_variants(dividers), compared, imu_rate_hz)) {
    for (const Variant& c : covariances) {
      const Variant both = combined(s, c);
      if (names.insert(variant_name(both, imu_rate_hz)).second) result.push_back(both);
    }
  }
  return result;
}

std::vector<Compared> compared_of(const std::vector<Variant>& variants,
                                  const std::vector<Accuracy>& accuracies,
                                  const std::vector<Cost>& costs, double imu_rate_hz) {
  std::vector<Compared> result;
  for (std::size_t v = 0; v < variants.size(); ++v) {
    result.push_back(
        {variants[v], variant_name(variants[v], imu_rate_hz), costs[v], accuracies[v], {}, false});
  }
  return result;
}

/// Sorts by cost, then marks the front.
void rank(std::vector<Compared>& variants) {
  std::sort(variants.begin(), variants.end(), [](const Compared& a, const Compared& b) {
    return a.cost.median_ns_per_s < b.cost.median_ns_per_s;
  });
  std::vector<ParetoPoint> points;
  for (const Compared& c : variants) {
    const Consistency consistency = consistency_of(c.accuracy);
    const bool is_out =
        consistency == Consistency::kNotFinite || consistency == Consistency::kDiverged;
    points.push_back(
        {c.cost.median_ns_per_s, c.cost.least_ns_per_s, c.cost.most_ns_per_s,
         is_out ? std::numeric_limits<double>::quiet_NaN() : c.accuracy.figures.rms_horizontal_m});
  }
  const auto dominated_by = dominators(points);
  for (std::size_t v = 0; v < variants.size(); ++v) {
    variants[v].dominated_by = dominated_by[v];
    variants[v].on_front = std::isfinite(points[v].error) && !dominated_by[v];
  }
}

void validate(const CompareOptions& options) {
  if (options.repeat < 1 || options.repeat > 1000) {
    throw Error("compare: repeat is " + std::to_string(options.repeat) + ", must be 1 to 1000");
  }
}

/// A part of the whole progress.
std::function<void(double)> part(const CompareOptions& options, double from, double to) {
  return [&options, from, to](double fraction) {
    if (options.progress) options.progress(from + fraction * (to - from));
  };
}

}  // namespace

double r95_of(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank =
      static_cast<std::ptrdiff_t>(std::ceil(0.95 * static_cast<double>(values.size())) - 1.0);
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

Consistency consistency_of(const Accuracy& accuracy) {
  const CampaignResult& r = accuracy.figures;
  if (r.not_finite > 0) return Consistency::kNotFinite;
  if (!accuracy.has_claim) return Consistency::kNoClaim;
  if (r.diverged > 0) return Consistency::kDiverged;
  if (r.mean_nees > r.nees_high) return Consistency::kOptimistic;
  return r.mean_nees < r.nees_low ? Consistency::kPessimistic : Consistency::kConsistent;
}

Scene comparable(const Scene& scene) {
  Scene plain = scene;
  plain.gnss.latency_s = 0.0;
  plain.gnss.outlier_probability = 0.0;
  return plain;
}

std::vector<Accuracy> accuracy_of(const std::vector<Variant>& variants, const Scene& scene,
                                  int threads, const std::function<void(double)>& progress) {
  const TrialPlan plan(comparable(scene), {}, threads);
  for (const Variant& variant : variants) {
    if (variant.imu_divider >= 1 && (variant.imu_divider == 1 || fits(plan, variant.imu_divider))) {
      continue;
    }
    throw Error("compare: imu_divider is " + std::to_string(variant.imu_divider) +
                ", must be >= 1, and every fix at the end of so many IMU increments");
  }
  return accuracy_in(plan, variants, threads, progress);
}

Comparison compare(const Scene& scene, const CompareOptions& options) {
  validate(options);
  Comparison result{comparable(scene), {}, {}};
  const TrialPlan plan(result.scene, {}, options.threads);
  const double rate_hz = scene.imu_rate_hz;
  result.imu_dividers = fitting_dividers(plan);

  std::vector<Variant> variants = sensible_variants(result.imu_dividers);
  std::vector<Accuracy> accuracies =
      accuracy_in(plan, variants, options.threads, part(options, 0.0, 0.6));
  // One round to see what is cheap: it warms the machine, and is not kept.
  const auto first = compared_of(variants, accuracies, costs_of(plan, variants, 1, {}), rate_hz);
  const std::vector<Variant> more = combinations(first, result.imu_dividers, rate_hz);
  const auto more_accuracies = accuracy_in(plan, more, options.threads, part(options, 0.65, 0.7));
  variants.insert(variants.end(), more.begin(), more.end());
  accuracies.insert(accuracies.end(), more_accuracies.begin(), more_accuracies.end());

  const auto costs = costs_of(plan, variants, options.repeat, part(options, 0.7, 1.0));
  result.variants = compared_of(variants, accuracies, costs, rate_hz);
  rank(result.variants);
  return result;
}

}  // namespace leeway::sim
