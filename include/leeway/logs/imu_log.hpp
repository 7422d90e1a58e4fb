/// @file
/// IMU logs: a streaming reader and the writer of the lossless layout.
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "leeway/earth/names.hpp"
#include "leeway/logs/csv_writer.hpp"
#include "leeway/logs/log_format.hpp"
#include "leeway/logs/log_reader.hpp"
#include "leeway/sensors/imu.hpp"

namespace leeway {

/// How an IMU log is read.
struct ImuLogOptions {
  RateMeaning meaning{RateMeaning::kPoint};           ///< of CSV logs of rates
  Eigen::Matrix3d C_bs{Eigen::Matrix3d::Identity()};  ///< sensor axes to body axes
  LogFormat format{};
};

/// A reader of IMU logs, plain or gzip, in constant memory. The layout is told from the content.
/// CSV may be of any dialect; its columns are found by name or an alias
/// (docs/guide/log-formats.md), in any order; further ones are noted in the summary.
///
/// - "CSV, rates": t_s, gx_radps, gy_radps, gz_radps, ax_mps2, ay_mps2, az_mps2.
/// - "CSV, increments": t_s, dt_s, dtheta_x_rad .. dtheta_z_rad, dv_x_mps .. dv_z_mps: lossless.
/// - "KF-GINS text": no header, blanks between: seconds of week, which count on past the end of the
///   week, dtheta xyz (rad), dv xyz (m/s).
/// - "u-blox UBX": ESF-RAW or ESF-MEAS; times are told by the NAV-PVT among them, to some 0.05 s.
/// - "PX4 ULog": sensor_combined, means of rates; times since the start of the system.
/// - "phone folder": a folder of CSV files, one a sensor, of Sensor Logger or phyphox.
///
/// A damaged line costs that line: one that cannot be parsed, with a number missing or not finite,
/// an angular rate beyond 1e3 rad/s (or rad) or a specific force beyond 1e5 m/s^2 (or m/s). So does
/// a time that goes back, repeats or jumps ahead of the lines after it. Repeated values under new
/// times are passed on as they are.
///
/// Increments are in body axes. In layouts without dt_s it is the time from the line before, and
/// the first line only starts the clock. Over a gap of rates the increment is a fiction: judge it
/// by its dt_s.
class ImuLogReader : public LogReader<ImuIncrement> {
 public:
  /// @throws Error when the file cannot be read, is empty, lacks columns (naming them), or C_bs is
  /// not a proper rotation to 1e-6.
  explicit ImuLogReader(const std::filesystem::path& path, const ImuLogOptions& options = {});
};

/// Writer of the layout of increments: every number reads back bit for bit. Errors and the partial
/// file are those of CsvWriter.
class ImuLogWriter {
 public:
  explicit ImuLogWriter(const std::filesystem::path& path);
  void write(const ImuIncrement& inc);
  void close() { csv_.close(); }

 private:
  CsvWriter csv_;
};

}  // namespace leeway
