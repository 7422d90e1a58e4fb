#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "sim/cli/command.hpp"
#include "sim/cli/jobs/interval_jobs.hpp"
#include "sim/cli/jobs/need.hpp"
#include "sim/cli/jobs/on_ranks.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/scene_options.hpp"
#include "sim/cli/tables/interval_tables.hpp"

namespace leeway::cli {
namespace {

struct IntervalCommand {
  IntervalChoice choice{};
  std::optional<double> need_s{};
  Output output{};
};

int run_on(const IntervalCommand& command, const sim::Ranks& ranks) {
  if (command.need_s) {
    if (!ranks.is_first()) return kSuccess;
    return answer_need(command.choice.scene, *command.need_s, command.output);
  }
  Json series = Json::object();
  const std::vector<SolvedImu> solved = solve_imus(command.choice, ranks, series);
  if (!ranks.is_first()) return kSuccess;
  show(
      command.output, interval_json(solved), [&] { print_interval_tables(solved); },
      [&] { return series; });
  return kSuccess;
}

/// The trials are shared by all processes that mpirun started; the linear analysis is done by each.
int run(const IntervalCommand& command) {
  return on_ranks([&command](const sim::Ranks& ranks) { return run_on(command, ranks); });
}

void add_options(CLI::App& app, IntervalCommand& command) {
  IntervalChoice& choice = command.choice;
  add_scene_options(app, choice.scene);
  auto* confirm = app.add_option("--confirm", choice.confirm_trials,
                                 "run so many trials of the scene's estimator at every answer")
                      ->check(in_range(0, 1000000))
                      ->type_name("N");
  app.add_option("--confirm-limit", choice.confirm_limits,
                 "confirm the answers for these limits only; several with commas")
      ->delimiter(',')
      ->type_name("LIMIT")
      ->needs(confirm);
  app.add_flag("--no-check", choice.no_check, "no trials at all: the linear analysis alone")
      ->excludes(confirm);
  auto* elasticities =
      app.add_flag("--elasticities", choice.with_sensitivity,
                   "beside every answer, how it changes with each specification of IMU, receiver "
                   "and aiding, its spread over the IMU's class, and closed forms of it");
  add_output_options(app, command.output);
  add_need_option(app, command.need_s)
      ->excludes(confirm)
      ->excludes(elasticities)
      ->excludes("--no-check")
      ->excludes("--report");
}

const Command<IntervalCommand> kInterval{
    "interval", "The longest time between fixes for which the error stays within a limit",
    "Without --imu: the five classes of the source paper, and the scene's own IMU. Without\n"
    "--limit: 1, 3, 10, 30 and 100 m, and the scene's own; a preset alone. Trials of the scene's\n"
    "estimator check the scene's IMU, or those named, at the scene's limit, and others as far as\n"
    "some seconds reach. A scene that scripts outages is asked for the error at their ends and\n"
    "the coast time.\n"
    "Examples:\n"
    "  leeway interval --scene docs/examples/scenes/town-car.toml\n"
    "  leeway interval --scene docs/examples/scenes/square-loop.toml --imu tactical --limit 10 "
    "--confirm 200\n"
    "  leeway interval --scene docs/examples/scenes/town-car.toml --need 60s --limit 15m",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
