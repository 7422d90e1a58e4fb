#include <algorithm>

#include "leeway/model/error_state.hpp"
#include "sim/reduce/reduction_parts.hpp"

namespace leeway::sim {
namespace {

constexpr double kWorthwhile = 0.05;  // of what the model costs: to less, costs do not repeat

class Choice {
 public:
  Choice(const TrialPlan& plan, const TermPrediction& prediction, const FilterModel& full,
         int rounds)
      : plan_(plan),
        prediction_(prediction),
        full_(full),
        full_accuracy_(prediction.of(full)),
        rounds_(rounds) {}

  /// Takes the terms that save most first, each that the limit and honesty leave room for.
  void drop_by_saving(std::vector<TermWorth> terms) {
    std::sort(terms.begin(), terms.end(),
              [](const TermWorth& a, const TermWorth& b) { return saving_of(a) > saving_of(b); });
    const double least =
        kWorthwhile * model_costs(plan_, {full_}, 1, {}).costs.front().median_ns_per_s;
    for (const TermWorth& term : terms) {
      if (!may_be_dropped(term.term) || saving_of(term) < least) continue;
      dropped_.push_back(term.term);
      if (!is_admissible(prediction_.of(without(full_, dropped_)))) dropped_.pop_back();
    }
  }

  /// Takes back what saves nothing beside the others: it is no reason for an error.
  void restore_the_idle() {
    for (std::size_t i = dropped_.size(); i-- > 0;) {
      std::vector<ModelTerm> fewer = dropped_;
      fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
      const ModelCosts costs =
          model_costs(plan_, {without(full_, fewer), without(full_, dropped_)}, rounds_, {});
      const double worthwhile = kWorthwhile * costs.costs.front().median_ns_per_s;
      if (costs.savings.back().median_ns_per_s < worthwhile) dropped_ = fewer;
    }
  }

  const std::vector<ModelTerm>& dropped() const { return dropped_; }

 private:
  static double saving_of(const TermWorth& term) {
    return term.cost ? term.cost->median_ns_per_s : 0.0;
  }

  bool is_admissible(const PredictedAccuracy& p) const {
    return p.is_finite && p.error_m <= kUsableLimit * plan_.scene().limit.limit_m &&
           is_as_honest(p.rms_over_sigma, p.nees, full_accuracy_.rms_over_sigma,
                        full_accuracy_.nees);
  }

  const TrialPlan& plan_;
  const TermPrediction& prediction_;
  const FilterModel& full_;
  PredictedAccuracy full_accuracy_;
  int rounds_;
  std::vector<ModelTerm> dropped_{};
};

}  // namespace

bool is_as_honest(double rms_over_sigma, double nees, double full_rms_over_sigma,
                  double full_nees) {
  const double states = kErrorStates;
  return rms_over_sigma <= kHonesty * std::max(1.0, full_rms_over_sigma) &&
         nees <= kHonesty * kHonesty * std::max(states, full_nees);
}

std::vector<ModelTerm> cheapest_terms(const TrialPlan& plan, const TermPrediction& prediction,
                                      const FilterModel& full, const std::vector<TermWorth>& terms,
                                      int rounds) {
  Choice choice(plan, prediction, full, rounds);
  choice.drop_by_saving(terms);
  choice.restore_the_idle();
  return choice.dropped();
}

}  // namespace leeway::sim
