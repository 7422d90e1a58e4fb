#include "sim/cli/scene_logs.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"
#include "leeway/logs/truth_log.hpp"
#include "leeway/sim/scene/receiver.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"

namespace leeway::cli {
namespace {

/// Number of steps of 1 / rate that fit, forgiving the rounding of their product.
std::int64_t steps(double duration_s, double rate_hz) {
  return static_cast<std::int64_t>(std::floor(duration_s * rate_hz * (1.0 + 1e-12)));
}

double time_s(std::int64_t k, double rate_hz, const sim::Scene& scene) {
  return std::min(static_cast<double>(k) / rate_hz, scene.duration_s);
}

std::int64_t write_imu(const sim::Scene& scene, std::uint64_t seed,
                       const std::filesystem::path& path, Progress& progress) {
  ImuLogWriter writer(path);
  sim::ImuErrorSimulator sensor(scene.imu, sim::Random(seed, 0, sim::kImuStream));
  const std::int64_t count = steps(scene.duration_s, scene.imu_rate_hz);
  double from_s = 0.0;
  for (std::int64_t k = 1; k <= count; ++k) {
    const double to_s = time_s(k, scene.imu_rate_hz, scene);
    writer.write(sensor.measure(sim::true_increment(scene.trajectory, from_s, to_s)));
    from_s = to_s;
    progress.show(static_cast<double>(k) / static_cast<double>(count));
  }
  writer.close();
  return count;
}

std::int64_t write_gnss(const sim::Scene& scene, std::uint64_t seed,
                        const std::filesystem::path& path) {
  GnssLogWriter writer(path);
  sim::Receiver receiver(scene.trajectory, scene.gnss, seed);
  const std::vector<double> times_s = fix_times_s(scene.gnss, scene.duration_s);
  for (const double t_s : times_s) writer.write(receiver.fix_at(t_s));
  writer.close();
  return static_cast<std::int64_t>(times_s.size());
}

std::int64_t write_truth(const sim::Scene& scene, double rate_hz,
                         const std::filesystem::path& path) {
  TruthLogWriter writer(path);
  const std::int64_t count = steps(scene.duration_s, rate_hz) + 1;
  for (std::int64_t k = 0; k < count; ++k) {
    const sim::TruthPoint truth = sim::truth_at(scene.trajectory, time_s(k, rate_hz, scene));
    writer.write({ned_from_nav_state(truth.nav), true, true});
  }
  writer.close();
  return count;
}

}  // namespace

SceneLogs write_scene_logs(const sim::Scene& scene, const SceneLogOptions& options,
                           Progress& progress) {
  validate(scene);
  std::error_code error;
  std::filesystem::create_directories(options.out, error);
  if (error) throw Error(options.out.string() + ": " + error.message());
  const auto path = [&options](const std::string& stem) {
    return options.out / (stem + (options.gzip ? ".csv.gz" : ".csv"));
  };
  SceneLogs logs{.imu = path("imu"), .gnss = path("gnss"), .truth = path("truth")};
  logs.imu_increments = write_imu(scene, options.seed, logs.imu, progress);
  logs.gnss_fixes = write_gnss(scene, options.seed, logs.gnss);
  logs.truth_rows = write_truth(scene, options.truth_rate_hz, logs.truth);
  return logs;
}

}  // namespace leeway::cli
