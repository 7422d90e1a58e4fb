#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/analysis/interval.hpp"
#include "sim/cli/answer.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/commands/interval_confirm.hpp"
#include "sim/cli/output.hpp"
#include "sim/cli/pages/interval_series.hpp"
#include "sim/cli/scene_options.hpp"
#include "sim/cli/tables/interval_tables.hpp"

namespace leeway::cli {
namespace {

struct IntervalChoice {
  SceneChoice scene{};
  int confirm_trials{0};
  std::vector<double> confirm_limits_m{};
  Output output{};
};

/// All five classes, unless the command line names IMUs; the scene's own when it is none of them.
std::vector<sim::Scene> scenes_to_solve(const SceneChoice& choice) {
  if (!choice.imus.empty()) return scenes_of(choice);
  SceneChoice classes = choice;
  classes.imus.assign(kNames<ImuClass>.begin(), kNames<ImuClass>.end());
  std::vector<sim::Scene> scenes = scenes_of(classes);
  SceneChoice as_written = choice;
  as_written.bias.reset();
  as_written.range.reset();
  sim::Scene own = scene_of(as_written);
  const auto is_class = [&own](ImuClass c) {
    return own.imu_name.starts_with(std::string(name(c)) + "/");
  };
  if (std::none_of(kAll<ImuClass>.begin(), kAll<ImuClass>.end(), is_class)) {
    scenes.push_back(std::move(own));
  }
  return scenes;
}

/// @throws Error when an answer is to be confirmed that was not asked for.
std::vector<double> limits_of(const IntervalChoice& options) {
  std::vector<double> limits_m = options.scene.limits_m;
  if (limits_m.empty()) limits_m = {1.0, 3.0, 10.0, 30.0, 100.0};
  for (const double limit_m : options.confirm_limits_m) {
    if (std::find(limits_m.begin(), limits_m.end(), limit_m) != limits_m.end()) continue;
    throw Error(fmt::format("--confirm-limit {:g}: not among the limits, which are {:g} m", limit_m,
                            fmt::join(limits_m, ", ")));
  }
  return limits_m;
}

/// @param series  gets the curves behind the answers
std::vector<SolvedImu> solve(const IntervalChoice& options, Json& series) {
  const std::vector<double> limits_m = limits_of(options);
  const std::vector<sim::Scene> scenes = scenes_to_solve(options.scene);
  std::vector<SolvedImu> solved;
  Progress progress("interval");
  for (const sim::Scene& scene : scenes) {
    const auto done = static_cast<double>(solved.size());
    const auto all = static_cast<double>(scenes.size());
    IntervalSeries curves;
    const auto show = [&](double fraction) { progress.show((done + fraction) / all); };
    solved.push_back({scene, sim::solve_intervals(scene, limits_m, curves.observed({}), show)});
    curves.add_to(series, scene.imu_name);
  }
  return solved;
}

int run(const IntervalChoice& options) {
  Json series = Json::object();
  std::vector<SolvedImu> solved = solve(options, series);
  if (options.confirm_trials > 0) {
    confirm(solved, options.confirm_trials, options.confirm_limits_m);
  }
  show(
      options.output, interval_json(solved), [&] { print_interval_tables(solved); },
      [&] { return series; });
  return kSuccess;
}

void add_options(CLI::App& app, IntervalChoice& options) {
  add_scene_options(app, options.scene);
  app.add_option("--confirm", options.confirm_trials,
                 "run so many Monte Carlo trials of the whole filter at every answer")
      ->check(CLI::Range(0, 1000000))
      ->type_name("N");
  app.add_option("--confirm-limit", options.confirm_limits_m,
                 "confirm the answers for these limits only, m; several with commas")
      ->delimiter(',')
      ->type_name("M")
      ->needs("--confirm");
  add_output_options(app, options.output);
}

const Command<IntervalChoice> kInterval{
    "interval", "The longest time between fixes for which the error stays within a limit",
    "Without --imu: the five classes of the source paper, and the scene's own IMU. Without\n"
    "--limit: 1, 3, 10, 30 and 100 m.\n"
    "Examples:\n"
    "  leeway interval --scene docs/examples/scenes/town-car.toml\n"
    "  leeway interval --scene docs/examples/scenes/square-loop.toml --imu tactical --limit 10 "
    "--confirm 200",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
