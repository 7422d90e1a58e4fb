#include "leeway/sim/compare/compare.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/sim/compare/pareto.hpp"
#include "leeway/sim/tools/quantile.hpp"
#include "leeway/sim/trials/trial.hpp"
#include "lib/earth/field_walk.hpp"
#include "sim/compare/filter_case.hpp"
#include "sim/trials/recorded_trial.hpp"

namespace leeway::sim {
namespace {

constexpr std::array kDividers{1, 2, 5};
constexpr std::size_t kSurvivors = 3;
constexpr double kSurvives = 1.01;  // of the default's error

std::vector<FilterCase> cases_of(const TrialPlan& plan, const std::vector<Variant>& variants) {
  std::vector<FilterCase> cases;
  for (const Variant& variant : variants) cases.push_back({&plan, variant, plan.scene().filter});
  return cases;
}

std::vector<Accuracy> accuracy_in(const TrialPlan& plan, const std::vector<Variant>& variants,
                                  int threads, const std::function<void(double)>& progress) {
  const auto runs = run_cases(cases_of(plan, variants), threads, progress);
  std::vector<Accuracy> result;
  for (std::size_t v = 0; v < variants.size(); ++v) {
    result.push_back({figures_of(runs[v]), quantile_of(sizes_m(ErrorMetric::kR95, runs[v]), 0.95),
                      variants[v].estimator != Estimator::kReset});
  }
  return result;
}

std::vector<Cost> costs_of(const TrialPlan& plan, const std::vector<Variant>& variants, int rounds,
                           const std::function<void(double)>& progress) {
  std::vector<Cost> costs;
  for (const auto& times : times_ns_per_s(cases_of(plan, variants), rounds, progress)) {
    costs.push_back(cost_of(times));
  }
  return costs;
}

std::vector<int> fitting_dividers(const TrialPlan& plan) {
  std::vector<int> dividers;
  for (const int n : kDividers) {
    // The scene's own rate is what the plan was made for.
    if (n == 1 || fits(plan, n)) dividers.push_back(n);
  }
  return dividers;
}

bool is_lost(const Compared& c) {
  const Consistency consistency = consistency_of(c.accuracy);
  return consistency == Consistency::kDiverged || consistency == Consistency::kNotFinite;
}

bool is_cheaper(const Compared& a, const Compared& b) {
  return a.cost.median_ns_per_s < b.cost.median_ns_per_s;
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
  std::vector<Compared> sorted;
  for (const Variant& variant : list) {
    const Compared& c = found(variant);
    if (!is_lost(c) && c.accuracy.figures.rms_horizontal_m <= limit_m) sorted.push_back(c);
  }
  std::sort(sorted.begin(), sorted.end(), is_cheaper);
  std::vector<Variant> result;
  for (const Compared& c : sorted) {
    if (result.size() < kSurvivors) result.push_back(c.variant);
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
  std::sort(variants.begin(), variants.end(), is_cheaper);
  std::vector<ParetoPoint> points;
  for (const Compared& c : variants) {
    points.push_back({c.cost.median_ns_per_s, c.cost.least_ns_per_s, c.cost.most_ns_per_s,
                      is_lost(c) ? std::nan("") : c.accuracy.figures.rms_horizontal_m});
  }
  const auto dominated_by = dominators(points);
  for (std::size_t v = 0; v < variants.size(); ++v) {
    variants[v].dominated_by = dominated_by[v];
    variants[v].on_front = std::isfinite(points[v].error) && !dominated_by[v];
  }
}

/// A part of the whole progress.
std::function<void(double)> part(const CompareOptions& options, double from, double to) {
  return [&options, from, to](double fraction) {
    if (options.progress) options.progress(from + fraction * (to - from));
  };
}

}  // namespace

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
  require("compare", "repeat", options.repeat, between(1.0, 1000.0));
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
