#include <cmath>

#include "leeway/sim/reduce/model_reduction.hpp"
#include "leeway/sim/scene/filter_file.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/files/output_files.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/scene_options.hpp"

namespace leeway::cli {
namespace {

struct ReduceChoice {
  SceneChoice scene{};
  sim::ReductionOptions reduction{};
  std::filesystem::path write{};
  Output output{};
};

std::string remark(const sim::TermWorth& term, double limit_m) {
  if (!std::isfinite(term.predicted_m)) return "P not positive";
  return sim::agrees(term, limit_m) ? "" : "apart";
}

void print_conditions(const sim::ModelReduction& reduction, int repeat) {
  const sim::Scene& scene = reduction.scene;
  fmt::print("Scene '{}': {:g} s, IMU {} at {:g} Hz, fixes every {:g} s; limit {:g} m ({})\n",
             scene.name, scene.duration_s, scene.imu_name, scene.imu_rate_hz, scene.gnss.interval_s,
             scene.limit.limit_m, name(scene.limit.metric));
  fmt::print(
      "Errors before each fix in the last {:g} s: {} trials, seeds {} to {}, no outliers, no gate. "
      "Cost: median of {} runs of the filter, ns per second of IMU data.\n",
      std::min(sim::scored_part_s(scene), scene.duration_s), scene.trials, scene.first_seed,
      scene.first_seed + static_cast<std::uint64_t>(scene.trials) - 1, repeat);
}

Row row_of(const sim::TermWorth& term, double limit_m) {
  return {{"<term", "term", name(term.term)},
          {"<substitute", "substitute", sim::substitute(term.term)},
          {"predicted, m", "predicted_m", term.predicted_m, 5},
          {"measured, m", "measured_m", term.measured_m, 5},
          {"ratio", "", term.predicted_m / term.measured_m, 2},
          {"<remark", "", remark(term, limit_m)},
          {"", "agrees", sim::agrees(term, limit_m)},
          {"diverged", "trials_diverged", term.diverged},
          {"cost, ns/s", "cost_ns_per_s", term.cost ? Json(term.cost->median_ns_per_s) : Json()},
          {"<in the reduced model", "",
           !term.cost     ? "unmodelled"
           : term.is_kept ? "kept"
                          : "dropped"},
          {"", "kept", term.cost.has_value() && term.is_kept}};
}

void print_terms(const sim::ModelReduction& reduction) {
  fmt::print(
      "\nWhat each term of the full model is worth: RMS of the difference that its substitute "
      "makes, horizontally\n");
  const double limit_m = reduction.scene.limit.limit_m;
  Table table = table_of(row_of(reduction.terms.front(), limit_m));
  for (const sim::TermWorth& term : reduction.terms) add_row(table, row_of(term, limit_m));
  table.print();
}

Row row_of(const sim::ModelReduction& reduction, const sim::ModelWorth& model, const char* title) {
  const sim::CampaignResult& r = model.measured.figures;
  const double cost = model.cost.median_ns_per_s;
  return {{"<model", "", title},
          {"ns/s", "cost_ns_per_s", cost},
          {"", "cost_least_ns_per_s", model.cost.least_ns_per_s},
          {"", "cost_most_ns_per_s", model.cost.most_ns_per_s},
          {"faster", "", reduction.full.cost.median_ns_per_s / cost, 2},
          {"predicted, m", "predicted_m", model.predicted.error_m, 3},
          {"measured, m", "measured_m", model.measured.error_m, 3},
          {"limit, m", "", reduction.scene.limit.limit_m, 3},
          {"RMS, m", "rms_horizontal_m", r.rms_horizontal_m, 3},
          {"", "predicted_rms_horizontal_m", model.predicted.rms_m},
          {"RMS/sigma", "rms_over_sigma", r.rms_over_sigma, 3},
          {"NEES", "nees", r.mean_nees, 2},
          {"", "nees_band", Json{r.nees_low, r.nees_high}},
          {"predicted NEES", "predicted_nees", model.predicted.nees, 2},
          {"", "difference_m", model.measured.difference_m},
          {"diverged", "trials_diverged", r.diverged},
          {"", "trials_not_finite", r.not_finite}};
}

/// The models compared: keys and rows.
std::vector<std::pair<const char*, Row>> models_of(const sim::ModelReduction& r) {
  return {{"full", row_of(r, r.full, "full")},
          {"full_covariance_0_1_s", row_of(r, r.standard, "full, P every 0.1 s")},
          {"reduced_full_rate", row_of(r, r.at_full_rate, "reduced, full IMU rate")},
          {"reduced", row_of(r, r.reduced, "reduced")}};
}

void print_models(const sim::ModelReduction& reduction) {
  fmt::print("\nThe full model, and the cheapest found that keeps the limit\n");
  Table table = table_of(row_of(reduction, reduction.full, ""));
  for (const auto& [key, row] : models_of(reduction)) add_row(table, row);
  table.print();
}

void print_verdict(const sim::ModelReduction& reduction) {
  const sim::CampaignResult& r = reduction.full.measured.figures;
  fmt::print(
      "\nThe reduced model {} the limit and claims {} (NEES {:.2f} to {:.2f} is consistent)\n",
      reduction.keeps_limit ? "keeps" : "misses",
      reduction.is_as_honest ? "as honestly as the full model" : "more than it keeps", r.nees_low,
      r.nees_high);
}

Json reduction_json(const sim::ModelReduction& reduction) {
  const double limit_m = reduction.scene.limit.limit_m;
  Json results{{"limit_m", limit_m}, {"terms", Json::array()}};
  for (const sim::TermWorth& term : reduction.terms) {
    results["terms"].push_back(row_json(row_of(term, limit_m)));
  }
  for (const auto& [key, row] : models_of(reduction)) results[key] = row_json(row);
  results["keeps_limit"] = reduction.keeps_limit;
  results["as_honest"] = reduction.is_as_honest;
  results["speedup"] = reduction.full.cost.median_ns_per_s / reduction.reduced.cost.median_ns_per_s;
  return results;
}

std::string reduction_comment(const sim::ModelReduction& reduction) {
  const sim::ModelWorth& reduced = reduction.reduced;
  return fmt::format(
      "The cheapest filter found for the scene '{}' within {:g} m ({}): {:.3f} m in {} trials,\n"
      "{:.3f} m with the full model; {:.2f} times as fast; RMS over sigma {:.3f} ({:.3f}), NEES "
      "{:.2f} ({:.2f}).",
      reduction.scene.name, reduction.scene.limit.limit_m, name(reduction.scene.limit.metric),
      reduced.measured.error_m, reduced.measured.figures.trials, reduction.full.measured.error_m,
      reduction.full.cost.median_ns_per_s / reduced.cost.median_ns_per_s,
      reduced.measured.figures.rms_over_sigma, reduction.full.measured.figures.rms_over_sigma,
      reduced.measured.figures.mean_nees, reduction.full.measured.figures.mean_nees);
}

sim::ModelReduction reduced(const ReduceChoice& options) {
  sim::ReductionOptions shown = options.reduction;
  Progress progress("reduce");
  shown.progress = std::ref(progress);
  return sim::reduce_model(scene_of(options.scene), shown);
}

int run(const ReduceChoice& options) {
  const sim::ModelReduction reduction = reduced(options);
  const int repeat = options.reduction.repeat;
  show(options.output,
       answer_json("reduce", timed_input_json(reduction.scene, repeat), reduction_json(reduction)),
       [&] {
         print_conditions(reduction, repeat);
         print_terms(reduction);
         print_models(reduction);
         print_verdict(reduction);
       });
  if (!reduction.keeps_limit || !reduction.is_as_honest) return kNoAnswer;
  if (!options.write.empty()) {
    const sim::Scene cheap = sim::with_model(reduction.scene, reduction.reduced.model);
    write_file(options.write, sim::filter_file(cheap, reduction_comment(reduction)));
  }
  return kSuccess;
}

void add_options(CLI::App& app, ReduceChoice& options) {
  add_scene_options(app, options.scene);
  add_trial_options(app, options.scene, 10'000, "of every model; in place of the scene's");
  add_repeat_option(app, options.reduction.repeat);
  add_threads_option(app, options.reduction.threads, "of what is not timed; ");
  add_output_file(app, "--write", options.write,
                  "write the cheapest filter as a file for --filter, if it keeps the limit",
                  "FILE.toml");
  add_output_options(app, options.output);
}

const Command<ReduceChoice> kReduce{
    "reduce",
    "What each term of the filter's model is worth in a scene, what it costs, and the cheapest "
    "filter that keeps the limit",
    "Exit code 2: no cheaper filter found that keeps the limit in the trials; none is written.\n"
    "Example:\n"
    "  leeway reduce --scene docs/examples/scenes/town-car.toml --write cheap.toml\n"
    "  leeway campaign --scene docs/examples/scenes/town-car.toml --filter cheap.toml",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
