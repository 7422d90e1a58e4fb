#include "sim/cli/commands/fuse_jobs.hpp"

#include <cmath>
#include <fstream>

#include "leeway/earth/rotation.hpp"
#include "leeway/sim/inspect/inspect_logs.hpp"
#include "sim/tools/json_error.hpp"

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

FuseJob job_with_options(const FuseLogs& logs) {
  FuseJob job;
  job.input = logs.files;
  LogForms forms = log_forms(logs.form);
  job.input.imu_options.format = std::move(forms.imu);
  job.input.gnss_options.format = std::move(forms.gnss);
  job.input.gnss_options.time_offset = duration_from_seconds(forms.gnss_time_offset_s);
  job.is_time_offset_to_find = forms.is_time_offset_to_find;
  if (logs.gnss_sigma_scale) {
    job.input.gnss_options.position_sigma_scale = logs.gnss_sigma_scale->x();
    job.input.gnss_options.velocity_sigma_scale = logs.gnss_sigma_scale->y();
  }
  return job;
}

void set_truth_window(sim::ReplayInput& input, const Eigen::Vector2d& window_s) {
  if (!(window_s.x() < window_s.y())) {
    throw Error(
        fmt::format("the truth window is from {:f} to {:f} s: its end must be later than its begin",
                    window_s.x(), window_s.y()));
  }
  input.truth_from_s = window_s.x();
  input.truth_to_s = window_s.y();
}

void set_solution_form(sim::ReplayInput& input, const std::optional<Eigen::Vector3d>& origin) {
  if (origin) {
    if (std::abs(origin->x()) > 90.0 || std::abs(origin->y()) > 360.0 ||
        std::abs(origin->z()) > 1e5) {
      throw Error(fmt::format(
          "--origin {:g},{:g},{:g}: LAT must be from -90 to 90 deg, LON from -360 to 360 deg, H "
          "from -100000 to 100000 m",
          origin->x(), origin->y(), origin->z()));
    }
    input.solution_form.origin = {origin->x() * kRadPerDeg, origin->y() * kRadPerDeg, origin->z()};
  }
  require_solution_form(input.solution, input.solution_form);
}

FuseJob job_of_logs(const FuseLogs& logs) {
  FuseJob job = job_with_options(logs);
  set_solution_form(job.input, logs.origin);
  job.mount_rpy_deg = logs.mount_rpy_deg;
  if (logs.truth_window_s) set_truth_window(job.input, *logs.truth_window_s);
  if (!logs.outages.empty()) job.input.outages = sim::read_outages(logs.outages);
  if (logs.start_heading_deg) {
    job.input.start_heading = {
        {}, *logs.start_heading_deg * kRadPerDeg, logs.start_heading_sigma_deg * kRadPerDeg};
  }
  return job;
}

/// meta.json: {"mount_rpy_deg": [r, p, y], "reference_window_s": [from, to] or null}.
FuseJob job_of_drive(const FuseLogs& logs, const std::filesystem::path& folder) {
  const std::filesystem::path meta_path = folder / "meta.json";
  std::ifstream file(meta_path);
  if (!file) throw Error(meta_path.string() + ": cannot be opened; a drive is a folder with one");
  FuseJob job = job_with_options(logs);
  job.drive = (folder / "").parent_path().filename().string();
  job.input.imu = folder / "imu.csv.gz";
  job.input.gnss = folder / "gnss.csv.gz";
  try {
    const Json meta = Json::parse(file);
    job.mount_rpy_deg.emplace(meta.at("mount_rpy_deg").get<std::array<double, 3>>().data());
    const Json& window = meta.at("reference_window_s");
    if (!window.is_null()) {
      job.input.truth = folder / "reference_position.csv.gz";
      set_truth_window(job.input, Eigen::Vector2d(window.get<std::array<double, 2>>().data()));
    }
  } catch (const Json::exception& error) {
    throw Error(
        meta_path.string() + ": " + sim::in_words(error) +
        R"(; wanted: {"mount_rpy_deg": [r, p, y], "reference_window_s": [from, to] or null})");
  }
  const std::filesystem::path outages = folder / "outages.json";
  if (std::filesystem::exists(outages)) job.input.outages = sim::read_outages(outages);
  return job;
}

/// --gnss-time-offset-s auto.
void find_time_offset(FuseJob& job) {
  sim::ReplayInput& in = job.input;
  const auto found = sim::find_clock_offset({in.imu, in.gnss, {}, in.imu_options, in.gnss_options});
  if (!found) {
    throw Error(in.gnss.string() +
                ": no turns by which to find the offset of its clock from that of " +
                in.imu.string() + "; say --gnss-time-offset-s in seconds");
  }
  in.gnss_options.time_offset += duration_from_seconds(found->offset_s);
  note(fmt::format("{}: times of fixes are put {:+.3f} s later (sigma {:.3f} s), by the turns",
                   in.gnss.string(), found->offset_s, found->sigma_s));
}

/// The folder, or those in it that are drives.
std::vector<std::filesystem::path> drives_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> drives;
  if (std::filesystem::is_directory(folder) && !std::filesystem::exists(folder / "meta.json")) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (std::filesystem::exists(entry.path() / "meta.json")) drives.push_back(entry.path());
    }
    std::sort(drives.begin(), drives.end());
  }
  if (drives.empty()) drives.push_back(folder);
  return drives;
}

bool is_without(const FuseVehicle& vehicle, const VehiclePart& part) {
  return std::any_of(vehicle.without.begin(), vehicle.without.end(),
                     [&](const auto& name) { return is_same_name(name, part.name); });
}

/// What a look at the logs may find, and the options tell already.
std::vector<std::string> taken_care_of(const FuseOptions& options, const FuseJob& job) {
  std::vector<std::string> about;
  if (job.estimates_mount) about.emplace_back("axes");
  if (options.timing.velocity_lag_s != 0.0) about.emplace_back("velocity-lag");
  if (options.timing.estimate_clock) about.emplace_back("clock-offset");
  return about;
}

/// An option that only a car has a use for, given without one; empty: there is none.
std::string asked_of_a_car(const FuseOptions& options) {
  const VehicleConfig has = VehicleConfig::of(options.vehicle.kind);
  for (const VehiclePart& part : kVehicleParts) {
    if (!(has.*part.is_on) && is_without(options.vehicle, part)) {
      return "--without " + std::string(part.name);
    }
  }
  for (std::size_t a = 0; a < kAidings.size(); ++a) {
    const bool is_given = !options.logs.files.aidings[a].empty();
    if (!(has.*kAidings[a].is_on) && is_given) return "--" + std::string(kAidings[a].name);
  }
  return {};
}

}  // namespace

VehicleConfig vehicle_config(const FuseVehicle& vehicle) {
  VehicleConfig config = VehicleConfig::of(vehicle.kind);
  for (const VehiclePart& part : kVehicleParts) {
    if (is_without(vehicle, part)) config.*part.is_on = false;
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
  if (const std::string asked = asked_of_a_car(options); !asked.empty()) {
    throw Error(asked + " is used with --vehicle car");
  }
  if (logs.drives.empty() && (logs.files.imu.empty() || logs.files.gnss.empty())) {
    throw Error("wanted: --imu and --gnss, or --drive");
  }
  std::vector<FuseJob> jobs;
  if (logs.drives.empty()) jobs.push_back(job_of_logs(logs));
  for (const auto& folder : logs.drives) {
    for (const auto& drive : drives_in(folder)) jobs.push_back(job_of_drive(logs, drive));
  }
  for (FuseJob& job : jobs) {
    const FuseVehicle& vehicle = options.vehicle;
    job.estimates_mount =
        vehicle.estimate_mount || (vehicle.kind == VehicleKind::kCar && !job.mount_rpy_deg);
    if (!job.estimates_mount) {
      job.input.imu_options.C_bs = mount_rotation(job.mount_rpy_deg, logs.mount_axes);
    } else if (logs.start_heading_deg) {
      throw Error(
          "--start-heading-deg is of the vehicle, and the mount is not known at the start: "
          "give --mount");
    }
    job.input.taken_care_of = taken_care_of(options, job);
    job.align_speed_mps = options.alignment.min_speed_mps;
    inspect(job);
    if (job.is_time_offset_to_find) find_time_offset(job);
  }
  return jobs;
}

}  // namespace leeway::cli
