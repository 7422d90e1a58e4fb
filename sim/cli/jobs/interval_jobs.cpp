#include "sim/cli/jobs/interval_jobs.hpp"

#include <spdlog/fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "leeway/navigator/aidings.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "sim/cli/pages/roofline_series.hpp"

namespace leeway::cli {
namespace {

/// IMU increments that checks nobody asked for may take, some five seconds' work of a processor.
constexpr double kSpareIncrements = 3e6;

/// Steps of the covariance that an answer to a hundredth may take: a day's course is steady.
constexpr double kRoughSteps = 1e4;

/// The scene with its own IMU. What the command line says of the biases and the range of a class is
/// not said of it.
sim::Scene own_scene(SceneChoice choice) {
  choice.imus.clear();
  choice.bias.reset();
  choice.range.reset();
  return scene_of(choice);
}

/// All five classes, unless the command line names IMUs; the scene's own when it is none of them.
std::vector<sim::Scene> scenes_to_solve(const SceneChoice& choice, const sim::Scene& own) {
  if (!choice.imus.empty()) return scenes_of(choice);
  SceneChoice classes = choice;
  classes.imus.assign(kNames<ImuClass>.begin(), kNames<ImuClass>.end());
  std::vector<sim::Scene> scenes = scenes_of(classes);
  const auto is_own = [&own](const sim::Scene& scene) { return scene.imu_name == own.imu_name; };
  if (std::none_of(scenes.begin(), scenes.end(), is_own)) scenes.push_back(own);
  return scenes;
}

/// Those of a table of lengths too, unless the scene's own limit is a preset or grows with the way.
/// @throws Error when an answer is to be confirmed that was not asked for.
std::vector<sim::AllowedError> limits_to_solve(const IntervalChoice& choice,
                                               const sim::ErrorLimit& own) {
  std::vector<sim::AllowedError> limits = limits_of(choice.scene.limit.limits);
  if (limits.empty()) {
    const bool is_alone = !own.preset.empty() || own.share > 0.0;
    if (!is_alone) limits = {1.0, 3.0, 10.0, 30.0, 100.0};
    if (std::ranges::count(limits, own.allowed()) == 0) limits.push_back(own.allowed());
    std::ranges::sort(limits, {}, &sim::AllowedError::limit_m);
  }
  for (const sim::AllowedError& limit : limits_of(choice.confirm_limits)) {
    if (std::ranges::count(limits, limit) > 0) continue;
    std::vector<std::string> asked;
    for (const sim::AllowedError& allowed : limits) asked.push_back(text_of(allowed));
    throw Error(fmt::format("--confirm-limit {}: not among the limits, which are {}",
                            text_of(limit), fmt::join(asked, ", ")));
  }
  return limits;
}

void solve_limits(SolvedImu& imu, const std::vector<sim::AllowedError>& limits,
                  sim::SceneTracks& tracks, const std::function<void(double)>& progress,
                  Json& series) {
  std::map<double, std::array<double, 2>> errors_m;  // by interval
  SeriesTable free_inertial({"t_s", "true_m"});
  sim::IntervalConfig config;
  config.tracks = &tracks;
  config.observer = [&errors_m](double interval_s, const sim::CovarianceAnalysis& analysis) {
    errors_m[interval_s] = {analysis.true_m, analysis.claimed_m};
  };
  config.free_inertial_observer = [&free_inertial](double t_s, double error_m) {
    free_inertial.add({t_s, error_m});
  };
  for (const sim::Interval& answer : solve_intervals(imu.scene, limits, config, progress)) {
    imu.limits.push_back({answer});
  }
  SeriesTable curve({"interval_s", "true_m", "claimed_m"});
  std::map<double, double> true_m;
  for (const auto& [interval_s, error] : errors_m) {
    curve.add({interval_s, error[0], error[1]});
    true_m[interval_s] = error[0];
  }
  series["curve/" + imu.scene.imu_name] = curve.json();
  series["free_inertial/" + imu.scene.imu_name] = free_inertial.json();
  series["roofline/" + imu.scene.imu_name] = roofline_series(imu.scene, true_m).json();
}

/// The sets of aiding that vehicles of this kind can have, each with what the one before has.
std::vector<std::pair<std::string, sim::SceneVehicle>> aiding_sets(const sim::SceneVehicle& own) {
  std::vector<std::pair<std::string, sim::SceneVehicle>> sets;
  sim::SceneVehicle vehicle = own;
  VehicleConfig& config = vehicle.config;
  for (const VehiclePart& part : kVehicleParts) config.*part.is_on = false;
  vehicle.odometer = vehicle.barometer = vehicle.heading = {};
  sets.emplace_back("none", vehicle);
  const VehicleConfig usual = VehicleConfig::of(own.config.kind);
  if (usual.zero_velocity || own.config.zero_velocity) {
    config.zero_velocity = config.zero_angular_rate = true;
    sets.emplace_back("standing still", vehicle);
  }
  if (usual.non_holonomic || own.config.non_holonomic) {
    config.non_holonomic = true;
    sets.emplace_back("and no side slip", vehicle);
  }
  const auto add_sensor = [&](const char* name, auto sensor, bool VehicleConfig::*is_on,
                              const sim::VehicleSensor& usual_one) {
    vehicle.*sensor = (own.*sensor).value_or(usual_one);
    config.*is_on = true;
    sets.emplace_back(name, vehicle);
  };
  if (usual.odometer || own.odometer) {
    add_sensor("and an odometer", &sim::SceneVehicle::odometer, &VehicleConfig::odometer,
               sim::kUsualOdometer);
  }
  add_sensor("and a barometer", &sim::SceneVehicle::barometer, &VehicleConfig::barometer,
             sim::kUsualBarometer);
  add_sensor("and a measured heading", &sim::SceneVehicle::heading, &VehicleConfig::heading,
             sim::kUsualHeading);
  return sets;
}

bool have_same_aiding(const sim::SceneVehicle& a, const sim::SceneVehicle& b) {
  return std::ranges::all_of(kVehicleParts, [&](const VehiclePart& part) {
    return a.config.*part.is_on == b.config.*part.is_on;
  });
}

/// @pre the scene's own limit is among those that are solved
void solve_aiding(SolvedImu& imu, sim::SceneTracks& tracks) {
  if (!imu.scene.vehicle) return;
  Progress bar("aiding");
  const sim::AllowedError own = imu.scene.limit.allowed();
  const auto answered = std::ranges::find(
      imu.limits, own, [](const SolvedLimit& answer) { return answer.interval.allowed(); });
  const auto sets = aiding_sets(*imu.scene.vehicle);
  sim::IntervalConfig config;
  config.tolerance = 1e-2;
  config.with_step_effect = false;
  config.tracks = &tracks;
  config.covariance_step_s = std::max(1.0, imu.scene.duration_s / kRoughSteps);
  for (const auto& [name, vehicle] : sets) {
    sim::Scene scene = imu.scene;
    scene.vehicle = vehicle;
    const bool is_the_scenes = have_same_aiding(vehicle, *imu.scene.vehicle);
    const sim::Interval interval =
        is_the_scenes ? answered->interval : solve_intervals(scene, {own}, config).front();
    imu.aided.push_back({name, is_the_scenes, interval});
    // More aiding does not shorten what less of it allows.
    if (!std::isnan(interval.interval_s)) config.first_guess_s = interval.interval_s;
    bar.show(static_cast<double>(imu.aided.size()) / static_cast<double>(sets.size()));
  }
}

bool has_interval(const SolvedLimit& answer) { return !std::isnan(answer.interval.interval_s); }

/// Trials of one answer. What goes wrong there is said beside the answer, which stands.
template <class F>
void try_trials(const sim::Scene& scene, const sim::ErrorTrack& track, const sim::Ranks& ranks,
                SolvedLimit& answer, F&& trials) {
  Progress bar(fmt::format("check {} at {:.1f} s", scene.imu_name, answer.interval.interval_s));
  try {
    answer.confirmation = trials(scene, track, answer.interval, ranks, std::ref(bar));
  } catch (const sim::RankFailure&) {
    throw;
  } catch (const Error& error) {
    answer.failure = error.what();
  }
}

/// What the answers depend on, at those that are an interval.
void solve_sensitivity(SolvedImu& imu) {
  Progress bar("elasticities");
  for (SolvedLimit& answer : imu.limits) {
    if (has_interval(answer)) answer.sensitivity = sensitivity_of(imu.scene, answer.interval);
  }
}

/// The answers that --confirm asks for.
void confirm(SolvedImu& imu, const IntervalChoice& choice, const sim::Ranks& ranks) {
  sim::Scene scene = imu.scene;
  scene.trials = choice.confirm_trials;
  const sim::ErrorTrack track = sim::error_track(scene);
  const std::vector<sim::AllowedError> asked = limits_of(choice.confirm_limits);
  for (SolvedLimit& answer : imu.limits) {
    const bool is_asked = asked.empty() || std::ranges::count(asked, answer.interval.allowed()) > 0;
    if (has_interval(answer) && is_asked) try_trials(scene, track, ranks, answer, sim::confirm);
  }
}

/// A cell of the table that may be checked.
struct Cell {
  SolvedImu* imu{};
  SolvedLimit* answer{};
  bool is_owed{};  ///< the scene's own question, or one that was asked by name
  double increments{};
};

std::vector<Cell> cells_to_check(std::vector<SolvedImu>& solved, const IntervalChoice& choice,
                                 const std::string& own_imu) {
  std::vector<Cell> cells;
  for (SolvedImu& imu : solved) {
    const sim::Scene& scene = imu.scene;
    const auto increments = static_cast<double>(
        sim::increment_count(scene.trajectory, scene.imu_rate_hz, scene.duration_s));
    const bool is_named = !choice.scene.imus.empty() || scene.imu_name == own_imu;
    for (SolvedLimit& answer : imu.limits) {
      if (!has_interval(answer)) continue;
      const bool is_owed = is_named && answer.interval.allowed() == scene.limit.allowed();
      cells.push_back({&imu, &answer, is_owed, increments * sim::kFewestTrials});
    }
  }
  std::ranges::stable_sort(cells, [](const Cell& a, const Cell& b) {
    if (a.is_owed != b.is_owed) return a.is_owed;
    return a.answer->interval.interval_s < b.answer->interval.interval_s;
  });
  return cells;
}

/// What is owed, and the shortest intervals as far as spare work reaches: counted, not timed, so
/// that the answer does not depend on the machine.
void check(std::vector<SolvedImu>& solved, const IntervalChoice& choice, const std::string& own_imu,
           const sim::Ranks& ranks) {
  double spare = kSpareIncrements;
  std::map<const SolvedImu*, sim::ErrorTrack> tracks;
  for (const Cell& cell : cells_to_check(solved, choice, own_imu)) {
    if (!cell.is_owed && cell.increments > spare) return;
    const sim::Scene& scene = cell.imu->scene;
    if (!tracks.contains(cell.imu)) tracks.emplace(cell.imu, sim::error_track(scene));
    try_trials(scene, tracks.at(cell.imu), ranks, *cell.answer, sim::check);
    if (cell.answer->confirmation) {
      spare -= cell.increments / sim::kFewestTrials *
               static_cast<double>(cell.answer->confirmation->trials_run);
    }
  }
}

}  // namespace

std::vector<SolvedImu> solve_imus(const IntervalChoice& choice, const sim::Ranks& ranks,
                                  Json& series) {
  const sim::Scene own = own_scene(choice.scene);
  const std::vector<sim::AllowedError> limits = limits_to_solve(choice, own.limit);
  const std::vector<sim::Scene> scenes = scenes_to_solve(choice.scene, own);
  std::vector<SolvedImu> solved;
  sim::SceneTracks tracks;
  Progress bar("interval");
  for (const sim::Scene& scene : scenes) {
    const auto progress = [&](double fraction) {
      const double done = static_cast<double>(solved.size()) + fraction;
      bar.show(done / static_cast<double>(scenes.size()));
    };
    SolvedImu imu{scene};
    if (scene.gnss.outages.empty()) {
      solve_limits(imu, limits, tracks, progress, series);
    } else {
      imu.coasts = sim::coasts(scene, sim::error_track(scene), scene.limit.allowed());
    }
    solved.push_back(std::move(imu));
  }
  if (!own.gnss.outages.empty()) return solved;
  for (SolvedImu& imu : solved) {
    if (scenes.size() == 1 || imu.scene.imu_name == own.imu_name) solve_aiding(imu, tracks);
    if (choice.with_sensitivity) solve_sensitivity(imu);
    if (choice.confirm_trials > 0) confirm(imu, choice, ranks);
  }
  if (choice.confirm_trials == 0 && !choice.no_check) check(solved, choice, own.imu_name, ranks);
  return solved;
}

}  // namespace leeway::cli
