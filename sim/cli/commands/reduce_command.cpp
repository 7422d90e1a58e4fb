#include <filesystem>

#include "leeway/sim/scene/filter_file.hpp"
#include "sim/cli/answer.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/output.hpp"
#include "sim/cli/scene_options.hpp"
#include "sim/cli/tables/reduce_tables.hpp"

namespace leeway::cli {
namespace {

struct ReduceChoice {
  SceneChoice scene{};
  sim::ReductionOptions reduction{};
  std::filesystem::path write{};
  Output output{};
};

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
       [&] { print_reduction(reduction, repeat); });
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
  app.add_option("--write", options.write,
                 "write the cheapest filter as a file for --filter, if it keeps the limit")
      ->type_name("FILE.toml");
  add_output_options(app, options.output);
}

const Command kReduce{
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
