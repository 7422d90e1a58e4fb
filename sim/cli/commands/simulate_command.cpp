#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"
#include "leeway/logs/truth_log.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/scene/receiver.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "sim/cli/command.hpp"
#include "sim/cli/files/output_files.hpp"
#include "sim/cli/options.hpp"
#include "sim/cli/scene_options.hpp"

namespace leeway::cli {
namespace {

/// A log that was written.
struct SceneLog {
  std::filesystem::path file{};
  std::int64_t rows{0};
};

/// Of the IMU, the receiver and the truth.
using SceneLogs = std::array<SceneLog, 3>;

/// A single-frequency code receiver under open sky.
struct GnssOptions {
  double interval_s{1.0};
  double sigma_h_m{0.5};
  double sigma_v_m{1.0};
  double sigma_velocity_mps{0.05};
  double correlated_sigma_m{1.5};
  double correlation_s{30.0};
};

struct SimulateChoice {
  std::filesystem::path scene{};  ///< in place of the options from here ..
  std::optional<sim::TrajectoryKind> trajectory{};
  double duration_s{600.0};
  double imu_rate_hz{200.0};
  ImuChoice imu{};
  GnssOptions gnss{};
  std::optional<Eigen::Vector3d> lever_arm_b_m{};  ///< .. to here
  std::optional<std::uint64_t> seed{};
  std::filesystem::path out{};  ///< folder; made when missing
  bool is_forced{false};        ///< logs in it may be replaced
  double truth_rate_hz{20.0};
  bool gzip{false};
  Output output{};
};

template <class Parameters, sim::Trajectory (*make)(const Parameters&)>
sim::Trajectory lasting(double duration_s) {
  Parameters parameters;
  parameters.duration_s = duration_s;
  return make(parameters);
}

// In the order of TrajectoryKind; the rest of them need a scene file.
constexpr std::array kFactories{&lasting<sim::StaticParameters, sim::static_trajectory>,
                                &lasting<sim::StraightParameters, sim::straight>,
                                &lasting<sim::CircleParameters, sim::circle>,
                                &lasting<sim::SquareLoopParameters, sim::square_loop>,
                                &lasting<sim::CarDriveParameters, sim::car_drive>};

sim::Scene scene_from_options(const SimulateChoice& options) {
  const NamedImu imu = imu_of(options.imu);
  sim::Scene scene;
  scene.name = name(*options.trajectory);
  scene.trajectory =
      kFactories.at(static_cast<std::size_t>(*options.trajectory))(options.duration_s);
  scene.duration_s = options.duration_s;
  scene.imu_rate_hz = options.imu_rate_hz;
  set_imu(scene, imu.name, imu.model);
  const GnssOptions& g = options.gnss;
  scene.gnss.interval_s = g.interval_s;
  scene.gnss.errors.position_sigma_n_m = {g.sigma_h_m, g.sigma_h_m, g.sigma_v_m};
  scene.gnss.errors.velocity_sigma_n_mps.setConstant(g.sigma_velocity_mps);
  scene.gnss.errors.correlated_sigma_n_m.setConstant(g.correlated_sigma_m);
  scene.gnss.errors.correlation_time_s = g.correlation_s;
  scene.gnss.errors.lever_arm_b_m = options.lever_arm_b_m.value_or(Eigen::Vector3d::Zero());
  return scene;
}

Json options_json(const SimulateChoice& options, const sim::Scene& scene) {
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
          {"lever_arm_m", json_of(scene.gnss.errors.lever_arm_b_m)}};
}

std::uint64_t seed_of(const SimulateChoice& options, const sim::Scene& scene) {
  return options.seed.value_or(scene.first_seed);
}

Json input_json(const SimulateChoice& options, const sim::Scene& scene) {
  Json input = options.scene.empty() ? options_json(options, scene) : scene_json(scene);
  input["truth_rate_hz"] = options.truth_rate_hz;
  input["seed"] = seed_of(options, scene);
  return input;
}

Json results_json(const SceneLogs& logs, const std::filesystem::path& description) {
  const auto& [imu, gnss, truth] = logs;
  return {{"imu", imu.file.string()},     {"gnss", gnss.file.string()},
          {"truth", truth.file.string()}, {"scene", description.string()},
          {"imu_increments", imu.rows},   {"gnss_fixes", gnss.rows},
          {"truth_rows", truth.rows}};
}

/// Number of steps of 1 / rate that fit, forgiving the rounding of their product.
std::int64_t steps(double duration_s, double rate_hz) {
  return static_cast<std::int64_t>(std::floor(duration_s * rate_hz * (1.0 + 1e-12)));
}

double time_s(std::int64_t k, double rate_hz, const sim::Scene& scene) {
  return std::min(static_cast<double>(k) / rate_hz, scene.duration_s);
}

/// @param row  what the log has as its row k
template <class Writer, class Row>
SceneLog write_log(const std::filesystem::path& file, std::int64_t rows, const Row& row) {
  Writer writer(file);
  for (std::int64_t k = 0; k < rows; ++k) writer.write(row(k));
  writer.close();
  return {file, rows};
}

SceneLog write_imu(const std::filesystem::path& file, const sim::Scene& scene, std::uint64_t seed) {
  Progress progress("simulate");
  sim::ImuErrorSimulator sensor(scene.imu, sim::Random(seed, 0, sim::kImuStream));
  const std::int64_t count = steps(scene.duration_s, scene.imu_rate_hz);
  return write_log<ImuLogWriter>(file, count, [&](std::int64_t k) {
    progress.show(static_cast<double>(k) / static_cast<double>(count));
    return sensor.measure(sim::true_increment(scene.trajectory, time_s(k, scene.imu_rate_hz, scene),
                                              time_s(k + 1, scene.imu_rate_hz, scene)));
  });
}

SceneLog write_gnss(const std::filesystem::path& file, const sim::Scene& scene,
                    std::uint64_t seed) {
  sim::Receiver receiver(scene.trajectory, scene.gnss, seed);
  const std::vector<double> times_s = fix_times_s(scene.gnss, scene.duration_s);
  return write_log<GnssLogWriter>(
      file, static_cast<std::int64_t>(times_s.size()),
      [&](std::int64_t k) { return receiver.fix_at(times_s[static_cast<std::size_t>(k)]); });
}

SceneLog write_truth(const std::filesystem::path& file, const sim::Scene& scene, double rate_hz) {
  return write_log<TruthLogWriter>(
      file, steps(scene.duration_s, rate_hz) + 1, [&](std::int64_t k) -> TruthRecord {
        const sim::TruthPoint truth = sim::truth_at(scene.trajectory, time_s(k, rate_hz, scene));
        return {ned_from_nav_state(truth.nav), true, true};
      });
}

/// @throws Error when the folder has such a file already and it is not to be replaced.
void claim(const SimulateChoice& options, const std::filesystem::path& file) {
  if (!options.is_forced && std::filesystem::exists(file)) {
    throw Error(file.string() + ": is there already; choose another folder, or say --force");
  }
  claim_output_file(file);
}

/// Claims the folder for what is written into it: the logs, and what they are of.
void claim_folder(const SimulateChoice& options) {
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) throw WriteFailure(options.out.string() + ": cannot be made: " + error.message());
  for (const char* log : {"imu.csv", "gnss.csv", "truth.csv"}) {
    const std::filesystem::path plain = options.out / log;
    const std::filesystem::path zipped = plain.string() + ".gz";
    claim(options, options.gzip ? zipped : plain);
    claim(options, options.gzip ? plain : zipped);
  }
  claim(options, options.out / "scene.json");
}

/// Writes the logs one after the other, in constant memory. Fixes in outages are left out, outliers
/// are in; a fix has the time it is valid at, whatever the latency.
/// @throws Error when a log cannot be written.
SceneLogs write_logs(const SimulateChoice& options, const sim::Scene& scene) {
  const std::string end = options.gzip ? ".csv.gz" : ".csv";
  const std::uint64_t seed = seed_of(options, scene);
  return {write_imu(options.out / ("imu" + end), scene, seed),
          write_gnss(options.out / ("gnss" + end), scene, seed),
          write_truth(options.out / ("truth" + end), scene, options.truth_rate_hz)};
}

void print_tables(const SimulateChoice& options, const sim::Scene& scene, const SceneLogs& logs) {
  fmt::print("Simulated {} s of '{}' into {}\n", scene.duration_s, scene.name,
             options.out.string());
  Table table({"<log", "rows", "<file"});
  constexpr std::array kTitles{"IMU increments", "GNSS fixes", "truth"};
  for (std::size_t i = 0; i < logs.size(); ++i) {
    table.add({kTitles[i], std::to_string(logs[i].rows), logs[i].file.string()});
  }
  table.print();
  if (scene.gnss.latency_s > 0.0) {
    fmt::print("Fixes have the time they are valid at; the scene delivers them {} s later.\n",
               scene.gnss.latency_s);
  }
}

int run(const SimulateChoice& options) {
  if (options.scene.empty() && !options.trajectory) {
    throw Error("simulate: give --scene FILE.toml or --trajectory NAME");
  }
  const sim::Scene scene =
      options.scene.empty() ? scene_from_options(options) : scene_from_file(options.scene);
  validate(scene);
  claim_folder(options);
  const std::filesystem::path description = options.out / "scene.json";
  const SceneLogs logs = writing([&] {
    const SceneLogs written = write_logs(options, scene);
    write_file(description, input_json(options, scene).dump(2) + "\n");
    return written;
  });
  show(options.output,
       answer_json("simulate", input_json(options, scene), results_json(logs, description)),
       [&] { print_tables(options, scene, logs); });
  return kSuccess;
}

void add_gnss_options(CLI::App& app, GnssOptions& g) {
  add_default_option(app, "--gnss-interval-s", g.interval_s,
                     "time between fixes, s; the first after one")
      ->check(in_range(1e-3, 1e6));
  add_default_option(app, "--gnss-sigma-h-m", g.sigma_h_m,
                     "white position error, 1 sigma north and east, m");
  add_default_option(app, "--gnss-sigma-v-m", g.sigma_v_m, "white position error, 1 sigma down, m");
  add_default_option(app, "--gnss-sigma-velocity-mps", g.sigma_velocity_mps,
                     "velocity error, 1 sigma per axis, m/s");
  add_default_option(app, "--gnss-correlated-sigma-m", g.correlated_sigma_m,
                     "slow position error (Gauss-Markov), 1 sigma per axis, m");
  add_default_option(app, "--gnss-correlation-s", g.correlation_s, "its correlation time, s");
}

/// A scene file says all that the options before it would.
void exclude_all(CLI::App& app, CLI::Option* scene) {
  for (CLI::Option* option : app.get_options()) {
    if (option != scene && option != app.get_help_ptr()) option->excludes(scene);
  }
}

void add_options(CLI::App& app, SimulateChoice& options) {
  app.add_option("--trajectory", options.trajectory, "the motion")
      ->transform(named<sim::TrajectoryKind>(kFactories.size()));
  add_default_option(app, "--duration-s", options.duration_s, "length, s")
      ->check(in_range(1.0, 1e6));
  add_default_option(app, "--imu-rate-hz", options.imu_rate_hz, "IMU increments per second")
      ->check(in_range(1.0, 1e4));
  add_imu_options(app, options.imu);
  add_gnss_options(app, options.gnss);
  add_numbers<3>(app, "--lever", "X,Y,Z", options.lever_arm_b_m,
                 "IMU to antenna, forward, right, down, m (default: 0,0,0)");
  exclude_all(app, add_file_option(app, "--scene", options.scene,
                                   "scene file, in place of all options above it", "FILE.toml"));
  add_default_option(app, "--truth-rate-hz", options.truth_rate_hz, "truth rows per second")
      ->check(in_range(0.1, 1e4));
  app.add_option("--seed", options.seed, "of the random numbers (default: 1, or the scene's)");
  add_file_option(app, "--out", options.out, "folder to write to; made when missing", "DIR")
      ->required();
  app.add_flag("--force", options.is_forced, "replace the logs that are in the folder already");
  app.add_flag("--gzip", options.gzip, "compress the logs: imu.csv.gz and so on");
  add_json_option(app, options.output.json);
}

const Command<SimulateChoice> kSimulate{
    "simulate", "Make IMU, GNSS and truth logs of a drive, for leeway fuse to read",
    "The GNSS defaults are typical of a single-frequency code receiver under open sky.\n"
    "Example:\n"
    "  leeway simulate --trajectory car --duration-s 1800 --imu-class tactical --out drive\n"
    "  leeway simulate --scene docs/examples/scenes/tunnel.toml --out tunnel",
    add_options, run};

}  // namespace
}  // namespace leeway::cli
