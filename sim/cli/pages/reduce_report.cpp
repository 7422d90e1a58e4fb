#include "sim/cli/pages/reduce_report.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace leeway::cli {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

double cost_of(const sim::TermWorth& term) { return term.cost ? term.cost->median_ns_per_s : kNan; }

std::string remark(const sim::TermWorth& term, double limit_m) {
  if (!std::isfinite(term.predicted_m)) return "P not positive";
  return sim::agrees(term, limit_m) ? "" : "apart";
}

void print_budget_conditions(const sim::ModelReduction& budget, int repeat) {
  const sim::Scene& scene = budget.scene;
  fmt::print("Scene '{}': {:g} s, IMU {} at {:g} Hz, fixes every {:g} s; limit {:g} m ({})\n",
             scene.name, scene.duration_s, scene.imu_name, scene.imu_rate_hz, scene.gnss.interval_s,
             scene.budget.limit_m, name(scene.budget.metric));
  fmt::print(
      "Errors before each fix in the last {:g} s: {} trials, seeds {} to {}, no outliers, no gate. "
      "Cost: median of {} runs of the filter, ns per second of IMU data.\n",
      std::min(sim::scored_part_s(scene), scene.duration_s), scene.trials, scene.first_seed,
      scene.first_seed + static_cast<std::uint64_t>(scene.trials) - 1, repeat);
}

void print_terms(const sim::ModelReduction& budget) {
  fmt::print(
      "\nWhat each term of the full model is worth: RMS of the difference that its substitute "
      "makes, horizontally\n");
  Table table({"<term", "<substitute", "predicted, m", "measured, m", "ratio", "<remark",
               "diverged", "cost, ns/s", "<in the reduced model"});
  for (const sim::TermWorth& term : budget.terms) {
    table.add({std::string(name(term.term)), std::string(sim::substitute(term.term)),
               number(term.predicted_m, 5), number(term.measured_m, 5),
               number(term.predicted_m / term.measured_m, 2),
               remark(term, budget.scene.budget.limit_m), fmt::format("{}", term.diverged),
               number(cost_of(term), 0),
               !term.cost     ? "unmodelled"
               : term.is_kept ? "kept"
                              : "dropped"});
  }
  table.print();
}

void print_models(const sim::ModelReduction& budget) {
  fmt::print("\nThe full model, and the cheapest found that keeps the limit\n");
  Table table({"<model", "ns/s", "faster", "predicted, m", "measured, m", "limit, m", "RMS, m",
               "RMS/sigma", "NEES", "predicted NEES", "diverged"});
  for (const auto& [model, title] :
       {std::pair{&budget.full, "full"}, std::pair{&budget.standard, "full, P every 0.1 s"},
        std::pair{&budget.at_full_rate, "reduced, full IMU rate"},
        std::pair{&budget.reduced, "reduced"}}) {
    const sim::CampaignResult& r = model->measured.figures;
    table.add({title, number(model->cost.median_ns_per_s, 0),
               number(budget.full.cost.median_ns_per_s / model->cost.median_ns_per_s, 2),
               number(model->predicted.error_m, 3), number(model->measured.error_m, 3),
               number(budget.scene.budget.limit_m, 3), number(r.rms_horizontal_m, 3),
               number(r.rms_over_sigma, 3), number(r.mean_nees, 2),
               number(model->predicted.nees, 2), fmt::format("{}", r.diverged)});
  }
  table.print();
}

void print_verdict(const sim::ModelReduction& budget) {
  const sim::CampaignResult& r = budget.full.measured.figures;
  fmt::print(
      "\nThe reduced model {} the limit and claims {} (NEES {:.2f} to {:.2f} is consistent)\n",
      budget.keeps_limit ? "keeps" : "misses",
      budget.is_as_honest ? "as honestly as the full model" : "more than it keeps", r.nees_low,
      r.nees_high);
}

Json model_json(const sim::ModelWorth& model) {
  const sim::CampaignResult& r = model.measured.figures;
  return {{"cost_ns_per_s", model.cost.median_ns_per_s},
          {"cost_least_ns_per_s", model.cost.least_ns_per_s},
          {"cost_most_ns_per_s", model.cost.most_ns_per_s},
          {"predicted_m", model.predicted.error_m},
          {"measured_m", model.measured.error_m},
          {"rms_horizontal_m", r.rms_horizontal_m},
          {"predicted_rms_horizontal_m", model.predicted.rms_m},
          {"rms_over_sigma", r.rms_over_sigma},
          {"nees", r.mean_nees},
          {"nees_band", {r.nees_low, r.nees_high}},
          {"predicted_nees", model.predicted.nees},
          {"difference_m", model.measured.difference_m},
          {"trials_diverged", r.diverged},
          {"trials_not_finite", r.not_finite}};
}

}  // namespace

void print_model_budget(const sim::ModelReduction& budget, int repeat) {
  print_budget_conditions(budget, repeat);
  print_terms(budget);
  print_models(budget);
  print_verdict(budget);
}

Json model_budget_json(const sim::ModelReduction& budget) {
  const double limit_m = budget.scene.budget.limit_m;
  Json terms = Json::array();
  for (const sim::TermWorth& term : budget.terms) {
    terms.push_back({{"term", name(term.term)},
                     {"substitute", sim::substitute(term.term)},
                     {"predicted_m", term.predicted_m},
                     {"measured_m", term.measured_m},
                     {"agrees", sim::agrees(term, limit_m)},
                     {"trials_diverged", term.diverged},
                     {"cost_ns_per_s", cost_of(term)},
                     {"kept", term.cost.has_value() && term.is_kept}});
  }
  return {{"limit_m", limit_m},
          {"terms", std::move(terms)},
          {"full", model_json(budget.full)},
          {"full_covariance_0_1_s", model_json(budget.standard)},
          {"reduced_full_rate", model_json(budget.at_full_rate)},
          {"reduced", model_json(budget.reduced)},
          {"keeps_limit", budget.keeps_limit},
          {"as_honest", budget.is_as_honest},
          {"speedup", budget.full.cost.median_ns_per_s / budget.reduced.cost.median_ns_per_s}};
}

std::string model_budget_comment(const sim::ModelReduction& budget) {
  const sim::ModelWorth& reduced = budget.reduced;
  return fmt::format(
      "The cheapest filter found for the scene '{}' within {:g} m ({}): {:.3f} m in {} trials,\n"
      "{:.3f} m with the full model; {:.2f} times as fast; RMS over sigma {:.3f} ({:.3f}), NEES "
      "{:.2f} ({:.2f}).",
      budget.scene.name, budget.scene.budget.limit_m, name(budget.scene.budget.metric),
      reduced.measured.error_m, reduced.measured.figures.trials, budget.full.measured.error_m,
      budget.full.cost.median_ns_per_s / reduced.cost.median_ns_per_s,
      reduced.measured.figures.rms_over_sigma, budget.full.measured.figures.rms_over_sigma,
      reduced.measured.figures.mean_nees, budget.full.measured.figures.mean_nees);
}

}  // namespace leeway::cli
