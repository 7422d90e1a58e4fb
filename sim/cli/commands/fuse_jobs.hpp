/// @file
/// What `leeway fuse` was asked for, and the runs it comes to.
#pragma once

#include "leeway/sim/replay/replay.hpp"
#include "sim/cli/log_options.hpp"
#include "sim/cli/options.hpp"

namespace leeway::cli {

/// The logs of one run, or folders that each hold a run.
struct FuseLogs {
  std::vector<std::filesystem::path> drives{};
  sim::ReplayInput files{};  ///< but for what is in a folder, and for the outages
  std::filesystem::path outages{};
  std::optional<Eigen::Vector2d> truth_window_s{};
  std::optional<Eigen::Vector3d> mount_rpy_deg{};
  std::string mount_axes{"flu"};
  std::optional<Eigen::Vector2d> gnss_sigma_scale{};  ///< of position, of velocity
  std::optional<Eigen::Vector3d> origin{};            ///< deg, deg, m
  std::optional<double> start_heading_deg{};
  double start_heading_sigma_deg{5.0};
  LogForm form{};
};

/// Aiding by what is known of the vehicle.
struct FuseVehicle {
  VehicleKind kind{VehicleKind::kNone};
  std::vector<std::string> without{};
  bool estimate_mount{false};
};

struct FuseOptions {
  FuseLogs logs{};
  FuseVehicle vehicle{};
  bool verbose{false};
  Output output{};
  ImuChoice imu{};
  EkfConfig filter{};  ///< all but the IMU model and the lever arm
  AlignmentConfig alignment{};
  TimingConfig timing{};
  std::optional<Eigen::Vector3d> lever_arm_b_m{};
};

/// One run through the navigator, and what came of it.
struct FuseJob {
  std::string drive{};  ///< name of its folder; empty when the logs were given one by one
  std::optional<Eigen::Vector3d> mount_rpy_deg{};
  bool estimates_mount{false};
  bool is_time_offset_to_find{false};
  double align_speed_mps{};  ///< from which the course is the heading
  std::string imu_format{};
  std::string gnss_format{};
  sim::ReplayInput input{};
  sim::ReplayResult result{};
};

/// The options of logs, of the navigator and of the vehicle: all that says how a log is run.
void add_log_options(CLI::App& app, FuseOptions& options);

/// @throws Error when the IMU model cannot be read or a number is out of range.
NavigatorConfig navigator_config(const FuseOptions& options, const ImuErrorModel& imu);

/// Reads what describes the runs and opens every log, so that unusable input shows before anything
/// is computed. @throws Error naming the file and what is wrong with it.
std::vector<FuseJob> fuse_jobs(const FuseOptions& options);

}  // namespace leeway::cli
