/// @file
/// A look at whole logs, without a filter.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"
#include "leeway/logs/scalar_log.hpp"
#include "leeway/sim/inspect/log_look.hpp"

namespace leeway::sim {

/// Logs to look at. An empty path: there is none.
struct LogsToInspect {
  std::filesystem::path imu{};
  std::filesystem::path gnss{};
  std::filesystem::path odometer{};
  ImuLogOptions imu_options{};
  GnssLogOptions gnss_options{};
};

/// What was read, and what it looks like.
struct InspectedLogs {
  LogLook look{};
  std::string imu_layout{};
  std::string gnss_layout{};
  LogSummary imu_summary{};
  LogSummary gnss_summary{};
};

/// The look at logs from end to end, in constant memory.
/// @param progress  called now and then with the time reached; may be empty
/// @throws Error when a file cannot be read.
InspectedLogs inspect(const LogsToInspect& logs, const std::function<void(Time)>& progress = {});

/// Columns of the log of an odometer.
ScalarColumns odometer_columns();

/// What is to be added to GNSS times, and how sure that is.
struct ClockOffset {
  double offset_s{};
  double sigma_s{};
};

/// The offset between the clocks of two logs, found from their turns and speed changes; within 20
/// s, or, where the logs share no time, within 20 s of a common begin. Nothing where they do not
/// match.
/// @throws Error when a file cannot be read.
std::optional<ClockOffset> find_clock_offset(LogsToInspect logs);

}  // namespace leeway::sim
