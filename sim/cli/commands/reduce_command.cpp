#include <filesystem>
#include <memory>
#include <optional>

#include "leeway/sim/scene/filter_file.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/output.hpp"
#include "sim/cli/pages/reduce_report.hpp"
#include "sim/cli/pages/report.hpp"
#include "sim/cli/scene_options.hpp"

namespace leeway::cli {
namespace {

struct BudgetCommand {
  SceneChoice scene{};
  std::optional<int> trials{};
  std::optional<std::uint64_t> first_seed{};
  sim::ReductionOptions budget{};
  std::filesystem::path write{};
  std::filesystem::path report{};
  bool json{false};
};

sim::Scene budget_scene(const BudgetCommand& options) {
  sim::Scene scene = scene_of(options.scene);
  if (options.trials) scene.trials = *options.trials;
  if (options.first_seed) scene.first_seed = *options.first_seed;
  return scene;
}

sim::ModelReduction budgeted(const BudgetCommand& options) {
  sim::ReductionOptions shown = options.budget;
  Progress progress("budget");
  shown.progress = [&progress](double fraction) { progress.show(fraction); };
  return sim::reduce_model(budget_scene(options), shown);
}

int run(const BudgetCommand& options) {
  const sim::ModelReduction budget = budgeted(options);
  Json input = scene_json(budget.scene);
  input.erase("gate_probability");  // there is no gate
  input["repeat"] = options.budget.repeat;
  const Json answer = answer_json("budget", std::move(input), model_budget_json(budget));
  if (options.json) {
    print_json(answer);
  } else {
    print_model_budget(budget, options.budget.repeat);
  }
  write_report(options.report, answer);
  if (!budget.keeps_limit || !budget.is_as_honest) return kNoAnswer;
  if (!options.write.empty()) {
    const sim::Scene reduced = sim::with_model(budget.scene, budget.reduced.model);
    write_file(options.write, sim::filter_file(reduced, model_budget_comment(budget)));
  }
  return kSuccess;
}

}  // namespace

void add_budget_command(CLI::App& program, int& exit_code) {
  CLI::App* app = program.add_subcommand(
      "budget",
      "What each term of the filter's model is worth in a scene, what it costs, and the "
      "cheapest filter that keeps the limit");
  const auto options = std::make_shared<BudgetCommand>();
  add_scene_options(*app, options->scene);
  app->add_option("--trials", options->trials, "of every model; in place of the scene's")
      ->check(CLI::Range(1, 10'000));
  app->add_option("--first-seed", options->first_seed,
                  "trial k has this seed + k; in place of the scene's")
      ->check(CLI::NonNegativeNumber);
  app->add_option("--repeat", options->budget.repeat, "timed runs of every model")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app->add_option("--threads", options->budget.threads, "of what is not timed; 0: all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  app->add_option("--write", options->write,
                  "write the cheapest filter as a file for --filter, if it keeps the limit")
      ->type_name("FILE.toml");
  add_report_option(*app, options->report);
  app->add_flag("--json", options->json, "one JSON object on standard output instead of tables");
  app->footer(
      "Exit code 2: no cheaper filter found that keeps the limit in the trials; none is written.\n"
      "Example:\n"
      "  leeway budget --scene docs/examples/scenes/town-car.toml --write cheap.toml\n"
      "  leeway campaign --scene docs/examples/scenes/town-car.toml --filter cheap.toml");
  app->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace leeway::cli
