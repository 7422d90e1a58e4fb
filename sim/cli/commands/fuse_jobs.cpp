#include "sim/cli/commands/fuse_jobs.hpp"

#include <algorithm>
#include <array>
#include <fstream>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway::cli {
namespace {

/// C_bs of a mount; without one the sensor axes are the body axes.
Eigen::Matrix3d mount_rotation(const std::optional<Eigen::Vector3d>& rpy_deg,
                               const std::string& axes) {
  if (!rpy_deg) return Eigen::Matrix3d::Identity();
  const Eigen::Vector3d rpy = *rpy_deg * kRadPerDeg;
  const Eigen::Matrix3d R = rotation_from_euler({rpy.x(), rpy.y(), rpy.z()});
  if (axes == "frd") return R;
  return Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal() * R;
}

/// A pipe delivers its content once, so it is not looked into beforehand.
bool can_be_read_twice(const std::filesystem::path& path) {
  return !std::filesystem::exists(path) || std::filesystem::is_regular_file(path) ||
         std::filesystem::is_directory(path);
}

/// Opens the logs and closes them again.
void inspect(FuseJob& job) {
  const sim::ReplayInput& in = job.input;
  job.imu_format = job.gnss_format = "stream";
  if (can_be_read_twice(in.imu)) {
    job.imu_format = ImuLogReader(in.imu, in.imu_options).layout();
  }
  if (can_be_read_twice(in.gnss)) {
    job.gnss_format = GnssLogReader(in.gnss, in.gnss_options).layout();
  }
  for (std::size_t a = 0; a < kAidings.size(); ++a) {
    if (in.aidings[a].empty() || !can_be_read_twice(in.aidings[a])) continue;
    ScalarLogReader{in.aidings[a], sim::columns_of(kAidings[a])};
  }
  if (!in.truth.empty() && can_be_read_twice(in.truth)) TruthLogReader{in.truth};
}

FuseJob job_with_options(const FuseOptions& options) {
  const FuseLogs& logs = options.logs;
  FuseJob job;
  job.input.imu_options.meaning = logs.rate_meaning;
  if (logs.gnss_sigma_scale) {
    job.input.gnss_options.position_sigma_scale = logs.gnss_sigma_scale->x();
    job.input.gnss_options.velocity_sigma_scale = logs.gnss_sigma_scale->y();
  }
  job.input.solution_rate_hz = options.output.rate_hz;
  return job;
}

void set_truth(sim::ReplayInput& input, const std::filesystem::path& truth,
               const std::optional<Eigen::Vector2d>& window_s) {
  input.truth = truth;
  if (!window_s) return;
  if (!(window_s->x() < window_s->y())) {
    throw Error("the truth window is from " + std::to_string(window_s->x()) + " to " +
                std::to_string(window_s->y()) + " s: its end must be later than its begin");
  }
  input.truth_from_s = window_s->x();
  input.truth_to_s = window_s->y();
}

FuseJob job_of_logs(const FuseOptions& options) {
  const FuseLogs& logs = options.logs;
  FuseJob job = job_with_options(options);
  job.mount_rpy_deg = logs.mount_rpy_deg;
  job.input.imu = logs.imu;
  job.input.gnss = logs.gnss;
  job.input.aidings = logs.aidings;
  job.input.solution = options.output.solution;
  set_truth(job.input, logs.truth, logs.truth_window_s);
  if (!logs.outages.empty()) job.input.outages = sim::read_outages(logs.outages);
  return job;
}

/// meta.json: {"mount_rpy_deg": [r, p, y], "reference_window_s": [from, to] or null}.
FuseJob job_of_drive(const FuseOptions& options, const std::filesystem::path& folder) {
  const std::filesystem::path meta_path = folder / "meta.json";
  std::ifstream file(meta_path);
  if (!file) throw Error(meta_path.string() + ": cannot be opened; a drive is a folder with one");
  FuseJob job = job_with_options(options);
  job.drive = (folder / "").parent_path().filename().string();
  job.input.imu = folder / "imu.csv.gz";
  job.input.gnss = folder / "gnss.csv.gz";
  try {
    const Json meta = Json::parse(file);
    const auto mount = meta.at("mount_rpy_deg").get<std::array<double, 3>>();
    job.mount_rpy_deg = Eigen::Vector3d(mount[0], mount[1], mount[2]);
    const Json& window = meta.at("reference_window_s");
    if (!window.is_null()) {
      const auto from_to = window.get<std::array<double, 2>>();
      set_truth(job.input, folder / "reference_position.csv.gz",
                Eigen::Vector2d(from_to[0], from_to[1]));
    }
  } catch (const Json::exception& error) {
    throw Error(meta_path.string() + ": " + error.what());
  }
  job.input.outages = sim::read_outages(folder / "outages.json");
  return job;
}

}  // namespace

VehicleConfig vehicle_config(const FuseVehicle& vehicle) {
  VehicleConfig config = VehicleConfig::of(vehicle.kind);
  if (vehicle.kind != VehicleKind::kCar) return config;
  for (const VehiclePart& part : kVehicleParts) {
    config.*part.is_on =
        std::none_of(vehicle.without.begin(), vehicle.without.end(),
                     [&](const auto& name) { return is_same_name(name, part.name); });
  }
  return config;
}

NavigatorConfig navigator_config(const FuseOptions& options, const ImuErrorModel& imu) {
  NavigatorConfig config;
  config.filter = options.filter;
  config.alignment = options.alignment;
  config.timing = options.timing;
  config.vehicle = vehicle_config(options.vehicle);
  config.filter.imu = imu;
  if (options.lever_arm_b_m) config.filter.lever_arm_b_m = *options.lever_arm_b_m;
  static_cast<void>(Navigator(config));  // refuses what cannot be
  return config;
}

std::vector<FuseJob> fuse_jobs(const FuseOptions& options) {
  const FuseLogs& logs = options.logs;
  const bool asks_for_a_vehicle =
      !options.vehicle.without.empty() || logs.aidings != sim::AidingLogs{};
  if (options.vehicle.kind != VehicleKind::kCar && asks_for_a_vehicle) {
    std::string names = "--without";
    for (const Aiding& a : kAidings) {
      names += (&a == &kAidings.back() ? " and --" : ", --") + std::string(a.name);
    }
    throw Error(names + " are used with --vehicle car");
  }
  if (logs.drives.empty() && (logs.imu.empty() || logs.gnss.empty())) {
    throw Error("fuse needs --imu and --gnss, or --drive");
  }
  std::vector<FuseJob> jobs;
  if (logs.drives.empty()) jobs.push_back(job_of_logs(options));
  for (const auto& folder : logs.drives) jobs.push_back(job_of_drive(options, folder));
  for (FuseJob& job : jobs) {
    const FuseVehicle& vehicle = options.vehicle;
    job.estimates_mount =
        vehicle.estimate_mount || (vehicle.kind == VehicleKind::kCar && !job.mount_rpy_deg);
    if (!job.estimates_mount) {
      job.input.imu_options.C_bs = mount_rotation(job.mount_rpy_deg, logs.mount_axes);
    }
    inspect(job);
  }
  return jobs;
}

}  // namespace leeway::cli
