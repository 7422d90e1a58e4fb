/// @file
/// Which scene a command is about: a file, and what the command line changes in it.
#pragma once

#include "leeway/sim/scene/scene.hpp"
#include "leeway/sim/sensors/bias_model.hpp"
#include "sim/cli/answer.hpp"
#include "sim/cli/limit_options.hpp"

namespace leeway::cli {

struct SceneChoice {
  std::filesystem::path file{};
  std::vector<std::string> imus{};       ///< empty: the scene's
  std::optional<RangeEnd> range{};       ///< of those that are Table 1 classes; absent: mid
  std::optional<sim::BiasModel> bias{};  ///< absent: as the scene or the model has it
  LimitChoice limit{};
  std::filesystem::path filter{};  ///< how the filter runs; empty: as the scene has it
  std::optional<double> at_s{};
  std::optional<double> interval_s{};
  std::optional<int> trials{};
  std::optional<std::uint64_t> first_seed{};
};

/// As sim::read_scene, with a note on stderr for each old name that the file uses.
sim::Scene scene_from_file(const std::filesystem::path& file,
                           std::optional<double> duration_s = {});

/// --scene, required, and the options that change it.
void add_scene_options(CLI::App& app, SceneChoice& choice);

/// --trials and --first-seed, of commands that draw errors.
/// @param meaning  of a number of trials
void add_trial_options(CLI::App& app, SceneChoice& choice, int most, const std::string& meaning);

/// The scene with the changes, one for each IMU asked for. An IMU from the command line is also
/// what the filter believes; of several limits a scene has the first.
/// @throws Error when the file is not a scene, a name is unknown, the trajectory ends before at_s,
/// or a change does not fit.
std::vector<sim::Scene> scenes_of(const SceneChoice& choice);

/// For commands about one scene. @throws Error also when several IMUs were asked for.
sim::Scene scene_of(const SceneChoice& choice);

/// What the scene is, for the input of --json.
Json scene_json(const sim::Scene& scene);

/// The same for studies that run without a gate and measure time, so many times.
Json timed_input_json(const sim::Scene& scene, int repeat);

}  // namespace leeway::cli
