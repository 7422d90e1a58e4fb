#include <algorithm>

#include "leeway/sim/compare/compare.hpp"
#include "sim/cli/answer.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/output.hpp"
#include "sim/cli/scene_options.hpp"
#include "sim/cli/tables/compare_tables.hpp"

namespace leeway::cli {
namespace {

constexpr double kEnoughS = 600.0;
constexpr double kEnoughFixes = 10.0;

struct CompareChoice {
  SceneChoice scene{.trials = 10};
  sim::CompareOptions compare{};
  Output output{};
};

/// A beginning of the scene unless --at says otherwise.
sim::Scene compared_scene(const CompareChoice& options) {
  sim::Scene scene = scene_of(options.scene);
  if (!options.scene.at_s) {
    const double enough_s = std::max(kEnoughS, kEnoughFixes * scene.gnss.interval_s);
    scene.duration_s = std::min(scene.duration_s, enough_s);
  }
  return scene;
}

sim::Comparison compared(const CompareChoice& options) {
  sim::CompareOptions shown = options.compare;
  Progress progress("compare");
  shown.progress = std::ref(progress);
  return sim::compare(compared_scene(options), shown);
}

int run(const CompareChoice& options) {
  const sim::Comparison comparison = compared(options);
  const int repeat = options.compare.repeat;
  show(options.output,
       answer_json("compare", timed_input_json(comparison.scene, repeat),
                   comparison_json(comparison)),
       [&] { print_comparison(comparison, repeat); });
  const bool any = std::any_of(comparison.variants.begin(), comparison.variants.end(),
                               [](const sim::Compared& c) { return c.on_front; });
  return any ? kSuccess : kNoAnswer;
}

void add_options(CLI::App& app, CompareChoice& options) {
  add_scene_options(app, options.scene);
  add_trial_options(app, options.scene, 10'000, "of every variant, for its errors (default: 10)");
  add_repeat_option(app, options.compare.repeat);
  add_threads_option(app, options.compare.threads, "of the runs that are not timed; ");
  add_output_options(app, options.output);
}

const Command kCompare{
    "compare", "What each way of running the filter costs in a scene, and how much it errs",
    "Without --at: the first 600 s of the scene, or ten fixes. Errors are the same to the bit\n"
    "whenever asked for; costs are of this machine, now.\n"
    "Example:\n"
    "  leeway compare --scene docs/examples/scenes/square-loop.toml --json > variants.json",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
