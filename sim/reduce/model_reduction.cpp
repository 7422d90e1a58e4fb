#include "leeway/sim/reduce/model_reduction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "leeway/earth/error.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "lib/earth/field_walk.hpp"
#include "sim/reduce/reduction_parts.hpp"

namespace leeway::sim {
namespace {

constexpr double kAgreesWithin = 0.2;        // of what was measured
constexpr double kAgreesWithinLimit = 0.01;  // or of the limit
constexpr double kWorthwhile = 0.05;  // of what the model costs: to less, costs do not repeat

void validate(const Scene& scene, const ReductionOptions& options) {
  require("reduce", "repeat", options.repeat, between(1.0, 1000.0));
  if (scene.limit.share > 0.0) {
    throw Error("reduce: the limit, " + text_of(scene.limit.allowed()) +
                ", grows with the distance since a fix: give one in metres alone, as --limit 10");
  }
  if (scene.gnss.latency_s >= scene.gnss.interval_s) {
    throw Error("reduce: latency_s of the fixes is " + std::to_string(scene.gnss.latency_s) +
                ", must be less than their interval_s, " + std::to_string(scene.gnss.interval_s));
  }
}

/// What a reduction leaves out, and the filters' own ways, which are what it is about.
Scene reduction_scene(const Scene& scene) {
  Scene plain = scene;
  plain.gnss.outlier_probability = 0.0;
  plain.imu_divider = 1;
  plain.filter = full_model(scene).config;
  return plain;
}

class Reduction {
 public:
  Reduction(const Scene& scene, const ReductionOptions& options)
      : options_(options),
        plan_(reduction_scene(scene), {}, options.threads),
        full_(full_model(plan_.scene())),
        prediction_(plan_, full_) {
    result_.scene = plan_.scene();
    for (const ModelTerm term : terms_of(plan_.scene())) result_.terms.push_back({.term = term});
    result_.full.model = full_;
  }

  ModelReduction run() {
    predict_terms();
    price_terms();
    const std::vector<ModelTerm> dropped = dropped_beside_others(dropped_by_saving());
    report(0.3);
    mark(dropped);
    choose_models(dropped);
    measure();
    price_models();
    judge();
    return std::move(result_);
  }

 private:
  void report(double fraction) const {
    if (options_.progress) options_.progress(fraction);
  }

  std::function<void(double)> part(double from, double to) const {
    return [this, from, to](double fraction) { report(from + fraction * (to - from)); };
  }

  void predict_terms() {
    parallel_for(
        result_.terms.size(),
        [this](std::size_t i) {
          TermWorth& term = result_.terms[i];
          const auto sources = sources_of(term.term);
          term.predicted_m = sources.empty()
                                 ? prediction_.of(without(full_, {term.term})).difference_m
                                 : prediction_.contribution_m(sources);
        },
        {}, options_.threads);
    report(0.1);
  }

  void price_terms() {
    std::vector<FilterModel> models{full_};
    for (const TermWorth& term : result_.terms) {
      if (sources_of(term.term).empty()) models.push_back(without(full_, {term.term}));
    }
    const ModelCosts costs = model_costs(plan_, models, options_.repeat, part(0.1, 0.2));
    auto saving = costs.savings.begin();
    for (TermWorth& term : result_.terms) {
      if (sources_of(term.term).empty()) term.cost = *++saving;
    }
  }

  bool is_admissible(const PredictedAccuracy& p, const PredictedAccuracy& full) const {
    return p.is_finite && p.error_m <= kUsableLimit * result_.scene.limit.limit_m &&
           is_as_honest(p.rms_over_sigma, p.nees, full.rms_over_sigma, full.nees);
  }

  /// The terms that save most first, each that the limit and honesty leave room for.
  std::vector<ModelTerm> dropped_by_saving() const {
    const auto saving_of = [](const TermWorth& term) {
      return term.cost ? term.cost->median_ns_per_s : 0.0;
    };
    std::vector<TermWorth> terms = result_.terms;
    std::sort(terms.begin(), terms.end(), [&](const TermWorth& a, const TermWorth& b) {
      return saving_of(a) > saving_of(b);
    });
    const PredictedAccuracy full = prediction_.of(full_);
    const double least =
        kWorthwhile * model_costs(plan_, {full_}, 1, {}).costs.front().median_ns_per_s;
    std::vector<ModelTerm> dropped;
    for (const TermWorth& term : terms) {
      if (!may_be_dropped(term.term) || saving_of(term) < least) continue;
      dropped.push_back(term.term);
      if (!is_admissible(prediction_.of(without(full_, dropped)), full)) dropped.pop_back();
    }
    return dropped;
  }

  /// Without what saves nothing beside the others: it is no reason for an error.
  std::vector<ModelTerm> dropped_beside_others(std::vector<ModelTerm> dropped) const {
    for (std::size_t i = dropped.size(); i-- > 0;) {
      std::vector<ModelTerm> fewer = dropped;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      const ModelCosts costs = model_costs(
          plan_, {without(full_, fewer), without(full_, dropped)}, options_.repeat, {});
      const double worthwhile = kWorthwhile * costs.costs.front().median_ns_per_s;
      if (costs.savings.back().median_ns_per_s < worthwhile) dropped = std::move(fewer);
    }
    return dropped;
  }

  void mark(const std::vector<ModelTerm>& dropped) {
    std::vector<ModelTerm> all = dropped;
    for (const ModelTerm term : dropped) {
      for (const ModelTerm implied : implied_by(term)) all.push_back(implied);
    }
    for (TermWorth& term : result_.terms) {
      term.is_kept = std::find(all.begin(), all.end(), term.term) == all.end();
    }
  }

  std::array<ModelWorth*, 4> models() {
    return {&result_.full, &result_.standard, &result_.at_full_rate, &result_.reduced};
  }

  void choose_models(const std::vector<ModelTerm>& dropped) {
    result_.full.model = full_;
    result_.standard.model = without(full_, {ModelTerm::kEachCovariance});
    result_.reduced.model = without(full_, dropped);
    result_.at_full_rate.model = result_.reduced.model;
    result_.at_full_rate.model.imu_divider = 1;
    for (ModelWorth* model : models()) model->predicted = prediction_.of(model->model);
  }

  void measure() {
    std::vector<FilterCase> cases;
    for (const ModelWorth* model : models()) cases.push_back(case_of(plan_, model->model));
    std::vector<std::unique_ptr<TrialPlan>> other_sensors;
    for (const TermWorth& term : result_.terms) {
      const auto sources = sources_of(term.term);
      if (sources.empty()) {
        cases.push_back(case_of(plan_, without(full_, {term.term})));
        continue;
      }
      other_sensors.push_back(std::make_unique<TrialPlan>(without_sources(plan_.scene(), sources),
                                                          std::nullopt, options_.threads));
      cases.push_back(case_of(*other_sensors.back(), full_));
    }
    const auto accuracies = measured(cases, options_.threads, part(0.3, 0.9));
    auto next = accuracies.begin();
    for (ModelWorth* model : models()) model->measured = *next++;
    for (TermWorth& term : result_.terms) {
      term.measured_m = next->difference_m;
      term.diverged = (next++)->figures.diverged;
    }
  }

  void price_models() {
    std::vector<FilterModel> filters;
    for (const ModelWorth* model : models()) filters.push_back(model->model);
    const ModelCosts costs = model_costs(plan_, filters, options_.repeat, part(0.9, 1.0));
    auto cost = costs.costs.begin();
    for (ModelWorth* model : models()) model->cost = *cost++;
  }

  void judge() {
    const MeasuredAccuracy& full = result_.full.measured;
    const MeasuredAccuracy& reduced = result_.reduced.measured;
    result_.keeps_limit =
        reduced.figures.not_finite == 0 && reduced.error_m <= result_.scene.limit.limit_m;
    result_.is_as_honest = is_as_honest(reduced.figures.rms_over_sigma, reduced.figures.mean_nees,
                                        full.figures.rms_over_sigma, full.figures.mean_nees);
  }

  const ReductionOptions& options_;
  TrialPlan plan_;
  FilterModel full_;
  TermPrediction prediction_;
  ModelReduction result_{};
};

}  // namespace

bool is_as_honest(double rms_over_sigma, double nees, double full_rms_over_sigma,
                  double full_nees) {
  const double states = kErrorStates;
  return rms_over_sigma <= kHonesty * std::max(1.0, full_rms_over_sigma) &&
         nees <= kHonesty * kHonesty * std::max(states, full_nees);
}

bool agrees(const TermWorth& term, double limit_m) {
  if (!std::isfinite(term.predicted_m)) return term.diverged > 0;
  const double apart_m = std::abs(term.predicted_m - term.measured_m);
  return apart_m <= kAgreesWithin * term.measured_m || apart_m <= kAgreesWithinLimit * limit_m;
}

ModelReduction reduce_model(const Scene& scene, const ReductionOptions& options) {
  validate(scene, options);
  return Reduction(scene, options).run();
}

}  // namespace leeway::sim
