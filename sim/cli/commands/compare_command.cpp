#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "leeway/sim/compare/compare.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/output.hpp"
#include "sim/cli/pages/compare_report.hpp"
#include "sim/cli/pages/report.hpp"
#include "sim/cli/scene_options.hpp"

namespace leeway::cli {
namespace {

constexpr double kEnoughS = 600.0;
constexpr double kEnoughFixes = 10.0;

struct CompareCommand {
  SceneChoice scene{};
  int trials{10};
  std::optional<std::uint64_t> first_seed{};
  sim::CompareOptions compare{};
  std::filesystem::path report{};
  bool json{false};
};

/// A beginning of the scene unless --at says otherwise, and the command's trials.
sim::Scene compared_scene(const CompareCommand& options) {
  sim::Scene scene = scene_of(options.scene);
  if (!options.scene.at_s) {
    const double enough_s = std::max(kEnoughS, kEnoughFixes * scene.gnss.interval_s);
    scene.duration_s = std::min(scene.duration_s, enough_s);
  }
  scene.trials = options.trials;
  if (options.first_seed) scene.first_seed = *options.first_seed;
  return scene;
}

sim::Comparison compared(const CompareCommand& options) {
  sim::CompareOptions shown = options.compare;
  Progress progress("compare");
  shown.progress = [&progress](double fraction) { progress.show(fraction); };
  return sim::compare(compared_scene(options), shown);
}

int run(const CompareCommand& options) {
  const sim::Comparison comparison = compared(options);
  Json input = scene_json(comparison.scene);
  input.erase("gate_probability");  // there is no gate
  input["repeat"] = options.compare.repeat;
  const Json answer = answer_json("compare", std::move(input), comparison_json(comparison));
  if (options.json) {
    print_json(answer);
  } else {
    print_comparison(comparison, options.compare.repeat);
  }
  // Last: a file that cannot be written must not cost the minutes that the rest took.
  write_report(options.report, answer);
  const bool any = std::any_of(comparison.variants.begin(), comparison.variants.end(),
                               [](const sim::Compared& c) { return c.on_front; });
  return any ? kSuccess : kNoAnswer;
}

}  // namespace

void add_compare_command(CLI::App& program, int& exit_code) {
  CLI::App* app = program.add_subcommand(
      "compare", "What each way of running the filter costs in a scene, and how much it errs");
  const auto options = std::make_shared<CompareCommand>();
  add_scene_options(*app, options->scene);
  app->add_option("--trials", options->trials, "of every variant, for its errors")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  app->add_option("--first-seed", options->first_seed,
                  "trial k has this seed + k; in place of the scene's")
      ->check(CLI::NonNegativeNumber);
  app->add_option("--repeat", options->compare.repeat, "timed runs of every variant")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app->add_option("--threads", options->compare.threads,
                  "of the runs that are not timed; 0: all processors")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  // Scripts may still have it.
  app->add_option("--csv")->group("")->check([](const std::string&) {
    return "gone: use --json, whose results[] has these rows, and nees_band";
  });
  add_report_option(*app, options->report);
  app->add_flag("--json", options->json, "one JSON object on standard output instead of tables");
  app->footer(
      "Without --at: the first 600 s of the scene, or ten fixes. Errors are the same to the bit\n"
      "whenever asked for; costs are of this machine, now.\n"
      "Example:\n"
      "  leeway compare --scene docs/examples/scenes/square-loop.toml --json");
  app->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace leeway::cli
