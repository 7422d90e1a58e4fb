#include <spdlog/fmt/ranges.h>

#include <cmath>

#include "sim/cli/command.hpp"
#include "sim/cli/pages/series_table.hpp"
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
    if (std::ranges::count(limits_m, limit_m) > 0) continue;
    throw Error(fmt::format("--confirm-limit {:g}: not among the limits, which are {:g} m", limit_m,
                            fmt::join(limits_m, ", ")));
  }
  return limits_m;
}

/// @param series  gets tables curve/IMU (interval_s, true_m, claimed_m) of the errors that were met
///                on the way, and free_inertial/IMU (t_s, true_m)
std::vector<sim::Interval> solve(const sim::Scene& scene, const std::vector<double>& limits_m,
                                 const std::function<void(double)>& progress, Json& series) {
  std::map<double, std::array<double, 2>> errors_m;  // by interval
  SeriesTable free_inertial({"t_s", "true_m"});
  sim::IntervalConfig config;
  config.observer = [&errors_m](double interval_s, const sim::CovarianceAnalysis& analysis) {
    errors_m[interval_s] = {analysis.true_m, analysis.claimed_m};
  };
  config.free_inertial_observer = [&free_inertial](double t_s, double error_m) {
    free_inertial.add({t_s, error_m});
  };
  std::vector<sim::Interval> intervals = solve_intervals(scene, limits_m, config, progress);
  SeriesTable curve({"interval_s", "true_m", "claimed_m"});
  for (const auto& [interval_s, error] : errors_m) curve.add({interval_s, error[0], error[1]});
  series["curve/" + scene.imu_name] = curve.json();
  series["free_inertial/" + scene.imu_name] = free_inertial.json();
  return intervals;
}

std::vector<SolvedImu> solve_all(const IntervalChoice& options, Json& series) {
  const std::vector<double> limits_m = limits_of(options);
  const std::vector<sim::Scene> scenes = scenes_to_solve(options.scene);
  std::vector<SolvedImu> solved;
  Progress bar("interval");
  for (const sim::Scene& scene : scenes) {
    const auto progress = [&](double fraction) {
      const double done = static_cast<double>(solved.size()) + fraction;
      bar.show(done / static_cast<double>(scenes.size()));
    };
    solved.push_back({scene, solve(scene, limits_m, progress, series)});
  }
  return solved;
}

/// The answers that are to be confirmed, by Monte Carlo.
void confirm(SolvedImu& imu, const IntervalChoice& options) {
  const std::vector<double>& limits_m = options.confirm_limits_m;
  sim::Scene scene = imu.scene;
  scene.trials = options.confirm_trials;
  const sim::ErrorTrack track = sim::error_track(scene);
  for (const sim::Interval& answer : imu.intervals) {
    imu.confirmations.emplace_back();
    const bool is_asked = limits_m.empty() || std::ranges::count(limits_m, answer.limit_m) > 0;
    if (std::isnan(answer.interval_s) || !is_asked) continue;
    Progress bar(fmt::format("confirm {} at {:.1f} s", scene.imu_name, answer.interval_s));
    imu.confirmations.back() = sim::confirm(scene, track, answer, std::ref(bar));
  }
}

int run(const IntervalChoice& options) {
  Json series = Json::object();
  std::vector<SolvedImu> solved = solve_all(options, series);
  if (options.confirm_trials > 0) {
    for (SolvedImu& imu : solved) confirm(imu, options);
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
