/// @file
/// What the parts of reduce_model() know of each other.
#pragma once

#include <memory>
#include <vector>

#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/reduce/model_reduction.hpp"
#include "leeway/sim/trials/trial.hpp"
#include "sim/compare/filter_case.hpp"

namespace leeway::sim {

/// Of the terms that no filter models: the errors of the sensors that they are.
std::vector<ErrorSource> sources_of(ModelTerm term);

/// What is left out with it.
std::vector<ModelTerm> implied_by(ModelTerm term);

/// Whether a choice may leave it out. Lever arm and latency are facts of the installation and save
/// nothing or little; float can lose P altogether; what no filter models is left out already.
bool may_be_dropped(ModelTerm term);

/// Predicts by linear analysis; runs no filter. Safe to share between threads.
class TermPrediction {
 public:
  /// @param plan  outlives this
  TermPrediction(const TrialPlan& plan, const FilterModel& full);
  ~TermPrediction();
  TermPrediction(const TermPrediction&) = delete;
  TermPrediction& operator=(const TermPrediction&) = delete;

  PredictedAccuracy of(const FilterModel& model) const;

  /// Root mean square that the sources add to the error of the full model.
  double contribution_m(const std::vector<ErrorSource>& sources) const;

 private:
  struct Track;
  std::unique_ptr<const Track> track_;
};

/// The filter of a model on the sensors of a plan, which outlives it.
FilterCase case_of(const TrialPlan& plan, const FilterModel& model);

/// All cases on the same noise, trial by trial; the first is what the others are compared with, and
/// its plan has trials, seeds and metric.
std::vector<MeasuredAccuracy> measured(const std::vector<FilterCase>& cases, int threads,
                                       const std::function<void(double)>& progress);

/// The costs of the models in the first trial of the plan, in their order, and of every model what
/// it saves of the first one, run just before it.
struct ModelCosts {
  std::vector<Cost> costs{};
  std::vector<Cost> savings{};
};
ModelCosts model_costs(const TrialPlan& plan, const std::vector<FilterModel>& models, int rounds,
                       const std::function<void(double)>& progress);

/// The scene with these errors of its sensors taken away, and every other random number the same.
Scene without_sources(Scene scene, const std::vector<ErrorSource>& sources);

/// Whether the reduced model keeps its promise as well as the full one: kHonesty.
bool is_as_honest(double rms_over_sigma, double nees, double full_rms_over_sigma, double full_nees);

}  // namespace leeway::sim
