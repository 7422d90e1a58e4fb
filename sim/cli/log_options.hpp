/// @file
/// What is said of logs on the command line, or in a file of their recorder.
#pragma once

#include "leeway/logs/log_format.hpp"
#include "sim/cli/options.hpp"

namespace leeway::cli {

/// Options of the form of logs. What is given here goes before what is in the file.
struct LogForm {
  std::filesystem::path file{};  ///< TOML with [imu] and [gnss]
  std::string imu_layout{};
  std::string gnss_layout{};
  std::string time_unit{};  ///< of both logs, or "IMU,GNSS"
  std::string gyro_unit{};
  std::string accel_unit{};
  std::string axes{};
  std::vector<std::string> columns{};  ///< "gx=wx"
  std::vector<double> gnss_sigma{};
  std::string gnss_time_offset{};  ///< seconds, or "auto"
};

struct LogForms {
  LogFormat imu{};
  LogFormat gnss{};
  double gnss_time_offset_s{0.0};      ///< added to the receiver's times
  bool is_time_offset_to_find{false};  ///< from turns and speed changes
};

void add_log_form_options(CLI::App& app, LogForm& form);

/// @throws Error when the file cannot be read or an option is not of its form.
LogForms log_forms(const LogForm& form);

}  // namespace leeway::cli
