#include <spdlog/fmt/fmt.h>

#include <array>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/scene/scene_file.hpp"
#include "sim/cli/commands.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/output.hpp"
#include "sim/cli/scene_logs.hpp"
#include "sim/cli/scene_options.hpp"

namespace leeway::cli {
namespace {

/// A single-frequency code receiver under open sky.
struct GnssOptions {
  double interval_s{1.0};
  double sigma_h_m{0.5};
  double sigma_v_m{1.0};
  double sigma_velocity_mps{0.05};
  double correlated_sigma_m{1.5};
  double correlation_s{30.0};
};

struct SimulateOptions {
  std::filesystem::path scene{};  ///< in place of the options from here ..
  std::optional<sim::TrajectoryKind> trajectory{};
  double duration_s{600.0};
  double imu_rate_hz{200.0};
  ImuChoice imu{};
  GnssOptions gnss{};
  std::optional<Eigen::Vector3d> lever_arm_b_m{};  ///< .. to here
  std::optional<std::uint64_t> seed{};
  SceneLogOptions logs{};
  bool json{false};
};

using Factory = std::function<sim::Trajectory(double duration_s)>;

template <class Parameters>
Factory factory(sim::Trajectory (*make)(const Parameters&)) {
  return [make](double duration_s) {
    Parameters parameters;
    parameters.duration_s = duration_s;
    return make(parameters);
  };
}

// In the order of TrajectoryKind; the rest of them need a scene file.
const std::array<Factory, 5> kFactories{factory(sim::static_trajectory), factory(sim::straight),
                                        factory(sim::circle), factory(sim::square_loop),
                                        factory(sim::car_drive)};

sim::GnssErrorModel gnss_model(const SimulateOptions& o) {
  const GnssOptions& g = o.gnss;
  sim::GnssErrorModel model;
  model.position_sigma_n_m = {g.sigma_h_m, g.sigma_h_m, g.sigma_v_m};
  model.velocity_sigma_n_mps.setConstant(g.sigma_velocity_mps);
  model.correlated_sigma_n_m.setConstant(g.correlated_sigma_m);
  model.correlation_time_s = g.correlation_s;
  model.lever_arm_b_m = o.lever_arm_b_m.value_or(Eigen::Vector3d::Zero());
  return model;
}

sim::Scene scene_from_options(const SimulateOptions& options) {
  const NamedImu imu = imu_of(options.imu);
  sim::Scene scene;
  scene.name = name(*options.trajectory);
  scene.trajectory =
      kFactories.at(static_cast<std::size_t>(*options.trajectory))(options.duration_s);
  scene.duration_s = options.duration_s;
  scene.imu_rate_hz = options.imu_rate_hz;
  set_imu(scene, imu.name, imu.model);
  scene.gnss.errors = gnss_model(options);
  scene.gnss.interval_s = options.gnss.interval_s;
  return scene;
}

Json options_json(const SimulateOptions& options, const sim::Scene& scene) {
  const GnssOptions& g = options.gnss;
  return {{"trajectory", name(*options.trajectory)},
          {"duration_s", options.duration_s},
          {"imu_rate_hz", options.imu_rate_hz},
          {"imu_model", scene.imu_name},
          {"gnss_interval_s", g.interval_s},
          {"gnss_sigma_h_m", g.sigma_h_m},
          {"gnss_sigma_v_m", g.sigma_v_m},
          {"gnss_sigma_velocity_mps", g.sigma_velocity_mps},
          {"gnss_correlated_sigma_m", g.correlated_sigma_m},
          {"gnss_correlation_s", g.correlation_s},
          {"lever_arm_m", json_of(options.lever_arm_b_m.value_or(Eigen::Vector3d::Zero()))}};
}

Json input_json(const SimulateOptions& options, const sim::Scene& scene) {
  Json input = options.scene.empty() ? options_json(options, scene) : scene_json(scene);
  input["truth_rate_hz"] = options.logs.truth_rate_hz;
  input["seed"] = options.logs.seed;
  return input;
}

Json results_json(const SceneLogs& logs, const std::filesystem::path& description) {
  return {{"imu", logs.imu.string()},
          {"gnss", logs.gnss.string()},
          {"truth", logs.truth.string()},
          {"scene", description.string()},
          {"imu_increments", logs.imu_increments},
          {"gnss_fixes", logs.gnss_fixes},
          {"truth_rows", logs.truth_rows}};
}

void print_report(const SimulateOptions& options, const sim::Scene& scene, const SceneLogs& logs) {
  fmt::print("Simulated {} s of '{}' into {}\n", scene.duration_s, scene.name,
             options.logs.out.string());
  Table table({"<log", "rows", "<file"});
  table.add({"IMU increments", std::to_string(logs.imu_increments), logs.imu.string()});
  table.add({"GNSS fixes", std::to_string(logs.gnss_fixes), logs.gnss.string()});
  table.add({"truth", std::to_string(logs.truth_rows), logs.truth.string()});
  table.print();
  if (scene.gnss.latency_s > 0.0) {
    fmt::print("Fixes have the time they are valid at; the scene delivers them {} s later.\n",
               scene.gnss.latency_s);
  }
}

int run(SimulateOptions options) {
  if (options.scene.empty() && !options.trajectory) {
    throw Error("simulate: give --scene FILE.toml or --trajectory NAME");
  }
  const sim::Scene scene =
      options.scene.empty() ? scene_from_options(options) : sim::read_scene(options.scene);
  options.logs.seed = options.seed.value_or(scene.first_seed);
  validate(scene);
  const std::filesystem::path description = options.logs.out / "scene.json";
  const SceneLogs logs = writing([&] {
    Progress progress("simulate");
    SceneLogs written = write_scene_logs(scene, options.logs, progress);
    write_file(description, input_json(options, scene).dump(2) + "\n");
    return written;
  });
  if (options.json) {
    print_json("simulate", input_json(options, scene), results_json(logs, description));
  } else {
    print_report(options, scene, logs);
  }
  return kSuccess;
}

void add_gnss_options(CLI::App& app, GnssOptions& g) {
  const auto add = [&app](const char* name, double& value, const char* description) {
    app.add_option(name, value, description)->capture_default_str();
  };
  app.add_option("--gnss-interval-s", g.interval_s, "time between fixes, s; the first after one")
      ->check(CLI::Range(1e-3, 1e6))
      ->capture_default_str();
  add("--gnss-sigma-h-m", g.sigma_h_m, "white position error, 1 sigma north and east, m");
  add("--gnss-sigma-v-m", g.sigma_v_m, "white position error, 1 sigma down, m");
  add("--gnss-sigma-velocity-mps", g.sigma_velocity_mps, "velocity error, 1 sigma per axis, m/s");
  add("--gnss-correlated-sigma-m", g.correlated_sigma_m,
      "slow position error (Gauss-Markov), 1 sigma per axis, m");
  add("--gnss-correlation-s", g.correlation_s, "its correlation time, s");
}

/// A scene file says all that the options before it would.
void exclude_all(CLI::App& app, CLI::Option* scene) {
  for (CLI::Option* option : app.get_options()) {
    if (option != scene && option != app.get_help_ptr()) option->excludes(scene);
  }
}

}  // namespace

void add_simulate_command(CLI::App& program, int& exit_code) {
  CLI::App* app = program.add_subcommand(
      "simulate", "Make IMU, GNSS and truth logs of a drive, for leeway fuse to read");
  const auto options = std::make_shared<SimulateOptions>();
  app->add_option("--trajectory", options->trajectory, "the motion")
      ->transform(named<sim::TrajectoryKind>(kFactories.size()));
  app->add_option("--duration-s", options->duration_s, "length, s")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  app->add_option("--imu-rate-hz", options->imu_rate_hz, "IMU increments per second")
      ->check(CLI::Range(1.0, 1e4))
      ->capture_default_str();
  add_imu_options(*app, options->imu);
  add_gnss_options(*app, options->gnss);
  add_numbers<3>(*app, "--lever", "X,Y,Z", options->lever_arm_b_m,
                 "IMU to antenna, forward, right, down, m (default: 0,0,0)");
  exclude_all(*app, app->add_option("--scene", options->scene,
                                    "scene file, in place of all options above it")
                        ->type_name("FILE.toml"));
  app->add_option("--truth-rate-hz", options->logs.truth_rate_hz, "truth rows per second")
      ->check(CLI::Range(0.1, 1e4))
      ->capture_default_str();
  app->add_option("--seed", options->seed, "of the random numbers (default: 1, or the scene's)");
  app->add_option("--out", options->logs.out, "folder to write to; made when missing")
      ->type_name("DIR")
      ->required();
  app->add_flag("--gzip", options->logs.gzip, "compress the logs: imu.csv.gz and so on");
  app->add_flag("--json", options->json, "one JSON object on standard output instead of a table");
  app->footer(
      "The GNSS defaults are typical of a single-frequency code receiver under open sky.\n"
      "Example:\n"
      "  leeway simulate --trajectory car --duration-s 1800 --imu-class tactical --out drive\n"
      "  leeway simulate --scene docs/examples/scenes/tunnel.toml --out tunnel");
  app->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace leeway::cli
