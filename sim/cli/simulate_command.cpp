#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "commands.hpp"
#include "leeway/gnss_log.hpp"
#include "leeway/imu_log.hpp"
#include "leeway/sim/gnss_simulator.hpp"
#include "leeway/sim/imu_simulator.hpp"
#include "leeway/sim/trajectories.hpp"
#include "leeway/truth_log.hpp"
#include "options.hpp"
#include "output.hpp"

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
  std::string trajectory{};
  double duration_s{600.0};
  double imu_rate_hz{200.0};
  double truth_rate_hz{20.0};
  std::uint64_t seed{1};
  ImuChoice imu{};
  GnssOptions gnss{};
  std::optional<Eigen::Vector3d> lever_arm_b_m{};
  std::filesystem::path out{};
  bool gzip{false};
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

const std::map<std::string, Factory>& factories() {
  static const std::map<std::string, Factory> all{{"static", factory(sim::static_trajectory)},
                                                  {"straight", factory(sim::straight)},
                                                  {"circle", factory(sim::circle)},
                                                  {"square-loop", factory(sim::square_loop)},
                                                  {"car", factory(sim::car_drive)}};
  return all;
}

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

/// Number of steps of 1 / rate that fit, forgiving the rounding of their product.
std::int64_t steps(double duration_s, double rate_hz) {
  return static_cast<std::int64_t>(std::floor(duration_s * rate_hz * (1.0 + 1e-12)));
}

/// The three logs, written one after the other so that memory stays constant.
class Simulation {
 public:
  explicit Simulation(const SimulateOptions& options)
      : options_(options),
        trajectory_(factories().at(options.trajectory)(options.duration_s)),
        imu_(imu_of(options.imu)),
        imu_errors_(imu_.model, sim::Random(options.seed, 0, sim::kImuStream)),
        gnss_(trajectory_, gnss_model(options), sim::Random(options.seed, 0, sim::kGnssStream)) {}

  std::filesystem::path path(const char* stem) const {
    return options_.out / (std::string(stem) + (options_.gzip ? ".csv.gz" : ".csv"));
  }

  void write(Progress& progress) {
    write_imu(progress);
    write_gnss();
    write_truth();
    write_file(options_.out / "scene.json", input_json().dump(2) + "\n");
  }

  Json input_json() const {
    const GnssOptions& g = options_.gnss;
    return {{"trajectory", options_.trajectory},
            {"duration_s", options_.duration_s},
            {"imu_rate_hz", options_.imu_rate_hz},
            {"imu_model", imu_.name},
            {"gnss_interval_s", g.interval_s},
            {"gnss_sigma_h_m", g.sigma_h_m},
            {"gnss_sigma_v_m", g.sigma_v_m},
            {"gnss_sigma_velocity_mps", g.sigma_velocity_mps},
            {"gnss_correlated_sigma_m", g.correlated_sigma_m},
            {"gnss_correlation_s", g.correlation_s},
            {"lever_arm_m", json_of(options_.lever_arm_b_m.value_or(Eigen::Vector3d::Zero()))},
            {"truth_rate_hz", options_.truth_rate_hz},
            {"seed", options_.seed}};
  }

  Json results_json() const {
    return {{"imu", path("imu").string()},        {"gnss", path("gnss").string()},
            {"truth", path("truth").string()},    {"scene", (options_.out / "scene.json").string()},
            {"imu_increments", imu_increments()}, {"gnss_fixes", gnss_fixes()},
            {"truth_rows", truth_rows()}};
  }

  std::int64_t imu_increments() const { return steps(options_.duration_s, options_.imu_rate_hz); }
  std::int64_t gnss_fixes() const {
    return steps(options_.duration_s, 1.0 / options_.gnss.interval_s);
  }
  std::int64_t truth_rows() const { return steps(options_.duration_s, options_.truth_rate_hz) + 1; }

 private:
  void write_imu(Progress& progress) {
    ImuLogWriter writer(path("imu"));
    const std::int64_t count = imu_increments();
    double from_s = 0.0;
    for (std::int64_t k = 1; k <= count; ++k) {
      const double to_s = time_s(k, options_.imu_rate_hz);
      writer.write(imu_errors_.measure(sim::true_increment(trajectory_, from_s, to_s)));
      from_s = to_s;
      progress.show(static_cast<double>(k) / static_cast<double>(count));
    }
    writer.close();
  }

  void write_gnss() {
    GnssLogWriter writer(path("gnss"));
    for (std::int64_t k = 1; k <= gnss_fixes(); ++k) {
      writer.write(gnss_.fix_at(time_s(k, 1.0 / options_.gnss.interval_s)));
    }
    writer.close();
  }

  void write_truth() {
    TruthLogWriter writer(path("truth"));
    for (std::int64_t k = 0; k < truth_rows(); ++k) {
      const double t_s = time_s(k, options_.truth_rate_hz);
      writer.write({ned_from_nav_state(sim::truth_at(trajectory_, t_s).nav), true, true});
    }
    writer.close();
  }

  double time_s(std::int64_t k, double rate_hz) const {
    return std::min(static_cast<double>(k) / rate_hz, options_.duration_s);
  }

  const SimulateOptions& options_;
  sim::Trajectory trajectory_;
  NamedImu imu_;
  sim::ImuErrorSimulator imu_errors_;
  sim::GnssSimulator gnss_;
};

void print_report(const SimulateOptions& options, const Simulation& simulation) {
  fmt::print("Simulated {} s of '{}' into {}\n", options.duration_s, options.trajectory,
             options.out.string());
  Table table({"<log", "rows", "<file"});
  table.add({"IMU increments", std::to_string(simulation.imu_increments()),
             simulation.path("imu").string()});
  table.add(
      {"GNSS fixes", std::to_string(simulation.gnss_fixes()), simulation.path("gnss").string()});
  table.add({"truth", std::to_string(simulation.truth_rows()), simulation.path("truth").string()});
  table.print();
}

int run(const SimulateOptions& options) {
  Simulation simulation(options);
  writing([&] {
    std::error_code error;
    std::filesystem::create_directories(options.out, error);
    if (error) throw Error(options.out.string() + ": " + error.message());
    Progress progress("simulate");
    simulation.write(progress);
  });
  if (options.json) {
    print_json("simulate", simulation.input_json(), simulation.results_json());
  } else {
    print_report(options, simulation);
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

}  // namespace

void add_simulate_command(CLI::App& program, int& exit_code) {
  CLI::App* app = program.add_subcommand(
      "simulate", "Make IMU, GNSS and truth logs of a drive, for leeway fuse to read");
  const auto options = std::make_shared<SimulateOptions>();
  std::vector<std::string> trajectories;
  for (const auto& [name, make] : factories()) trajectories.push_back(name);
  app->add_option("--trajectory", options->trajectory, "the motion")
      ->check(CLI::IsMember(trajectories))
      ->required();
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
  app->add_option("--truth-rate-hz", options->truth_rate_hz, "truth rows per second")
      ->check(CLI::Range(0.1, 1e4))
      ->capture_default_str();
  app->add_option("--seed", options->seed, "of the random numbers")->capture_default_str();
  app->add_option("--out", options->out, "folder to write to; made when missing")
      ->type_name("DIR")
      ->required();
  app->add_flag("--gzip", options->gzip, "compress the logs: imu.csv.gz and so on");
  app->add_flag("--json", options->json, "one JSON object on standard output instead of a table");
  app->footer(
      "The GNSS defaults are typical of a single-frequency code receiver under open sky.\n"
      "Example:\n"
      "  leeway simulate --trajectory car --duration-s 1800 --imu-class tactical --out drive");
  app->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace leeway::cli
