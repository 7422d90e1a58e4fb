#include "sim/cli/scene_options.hpp"

#include "leeway/sim/scene/filter_file.hpp"
#include "leeway/sim/scene/scene_file.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/quantity.hpp"

namespace leeway::cli {
namespace {

NamedImu imu_of_option(const std::string& wanted, RangeEnd range) {
  try {
    return imu_named(wanted, range);
  } catch (const Error& error) {
    throw Error(fmt::format("--imu {}: no class (automotive-mems, {}) and no part: {}", wanted,
                            fmt::join(kNames<ImuClass>, ", "), error.what()));
  }
}

sim::Scene with_imu(sim::Scene scene, const NamedImu& imu, std::optional<sim::BiasModel> bias) {
  set_imu(scene, imu.name, bias ? with_bias_model(imu.model, *bias) : imu.model);
  return scene;
}

sim::Scene changed_scene(const SceneChoice& choice) {
  sim::Scene scene = scene_from_file(choice.file, choice.at_s);
  change_limit(choice.limit, scene.limit);
  if (!choice.filter.empty()) sim::read_filter_file(choice.filter, scene);
  if (choice.interval_s) scene.gnss.interval_s = *choice.interval_s;
  if (choice.trials) scene.trials = *choice.trials;
  if (choice.first_seed) scene.first_seed = *choice.first_seed;
  return scene;
}

Json gnss_json(const sim::GnssScenario& gnss) {
  Json outages = Json::array();
  for (const sim::Outage& outage : gnss.outages) {
    outages.push_back({{"start_s", outage.start_s}, {"duration_s", outage.duration_s}});
  }
  const sim::GnssErrorModel& errors = gnss.errors;
  return {{"interval_s", gnss.interval_s},
          {"settle_s", gnss.settle_s},
          {"settle_interval_s", gnss.settle_interval_s},
          {"position_sigma_ned_m", json_of(errors.position_sigma_n_m)},
          {"velocity_sigma_ned_mps", json_of(errors.velocity_sigma_n_mps)},
          {"correlated_sigma_ned_m", json_of(errors.correlated_sigma_n_m)},
          {"correlation_s", errors.correlation_time_s},
          {"lever_arm_m", json_of(errors.lever_arm_b_m)},
          {"latency_s", gnss.latency_s},
          {"outlier_probability", gnss.outlier_probability},
          {"outlier_sigma_m", gnss.outlier_sigma_m},
          {"outages", std::move(outages)}};
}

}  // namespace

sim::Scene scene_from_file(const std::filesystem::path& file, std::optional<double> duration_s) {
  std::vector<std::string> notes;
  sim::Scene scene = sim::read_scene(file, duration_s, &notes);
  for (const std::string& text : notes) note(text);
  return scene;
}

void add_scene_options(CLI::App& app, SceneChoice& choice) {
  add_file_option(app, "--scene", choice.file, "scene file (docs/guide/scenes.md lists its keys)",
                  "FILE.toml")
      ->required();
  app.add_option("--imu", choice.imus,
                 "IMU in place of the scene's, for truth and filter: marine, aviation, "
                 "intermediate, tactical, automotive, automotive-mems, or a part of the "
                 "catalogue; several with commas")
      ->type_name("NAME")
      ->delimiter(',');
  add_range_option(app, choice.range);
  app.add_option("--bias", choice.bias,
                 "what the biases of a Table 1 class do after turn-on: stay, or wander with a "
                 "correlation time of an hour")
      ->transform(named<sim::BiasModel>());
  add_file_option(
      app, "--filter", choice.filter,
      "how the filter runs, in place of the scene's [filter]: a file that leeway reduce "
      "--write made",
      "FILE.toml");
  add_limit_options(app, choice.limit);
  app.add_option("--at", choice.at_s,
                 "end the scene at this time, s, earlier or later than it does")
      ->check(in_range(1.0, 1e6))
      ->type_name("SECONDS");
  app.add_option("--interval-s", choice.interval_s, "time between fixes, s")
      ->check(in_range(1e-3, 1e6));
}

void add_trial_options(CLI::App& app, SceneChoice& choice, int most, const std::string& meaning) {
  app.add_option("--trials", choice.trials, meaning)->check(in_range(1, most));
  app.add_option("--first-seed", choice.first_seed,
                 "trial k has this seed + k; in place of the scene's")
      ->check(not_negative());
}

std::vector<sim::Scene> scenes_of(const SceneChoice& choice) {
  if (choice.imus.empty() && choice.range) {
    throw Error(
        fmt::format("--range {} is of a Table 1 class: name it with --imu", name(*choice.range)));
  }
  const sim::Scene base = changed_scene(choice);
  std::vector<sim::Scene> scenes;
  for (const std::string& imu : choice.imus) {
    scenes.push_back(
        with_imu(base, imu_of_option(imu, choice.range.value_or(RangeEnd::kMid)), choice.bias));
  }
  if (scenes.empty() && !choice.bias) scenes.push_back(base);
  if (scenes.empty()) scenes.push_back(with_imu(base, {base.imu_name, base.imu}, choice.bias));
  for (const sim::Scene& scene : scenes) validate(scene);
  return scenes;
}

sim::Scene scene_of(const SceneChoice& choice) {
  if (choice.imus.size() > 1) {
    throw Error("--imu: this command takes one IMU, not " + std::to_string(choice.imus.size()));
  }
  return scenes_of(choice).front();
}

Json scene_json(const sim::Scene& scene) {
  Json json{{"scene", scene.name},
            {"motion", scene.trajectory.name},
            {"duration_s", scene.duration_s},
            {"imu_rate_hz", scene.imu_rate_hz},
            {"estimator", name(scene.estimator)},
            {"vehicle", scene.vehicle ? Json(name(scene.vehicle->config.kind)) : Json()},
            {"imu_model", scene.imu_name},
            {"bias_model", name(sim::bias_model_of(scene.imu))},
            {"gnss", gnss_json(scene.gnss)},
            {"gate_probability", scene.filter.gate_probability},
            {"last_s", scene.limit.last_s},
            {"trials", scene.trials},
            {"first_seed", scene.first_seed}};
  json.update(limit_json(scene.limit));
  return json;
}

Json timed_input_json(const sim::Scene& scene, int repeat) {
  Json input = scene_json(scene);
  input.erase("gate_probability");
  input["repeat"] = repeat;
  return input;
}

}  // namespace leeway::cli
