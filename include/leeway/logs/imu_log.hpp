/// @file
/// IMU logs: a streaming reader and the writer of the lossless layout.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <optional>

#include "leeway/earth/names.hpp"
#include "leeway/logs/csv_writer.hpp"
#include "leeway/logs/log_summary.hpp"
#include "leeway/sensors/imu.hpp"

namespace leeway {

/// Told from the content of the file. CSV columns are found by name, in any order; further columns
/// are ignored.
enum class ImuLogFormat {
  kCsvRates,       ///< t_s, gx_radps, gy_radps, gz_radps, ax_mps2, ay_mps2, az_mps2
  kCsvIncrements,  ///< t_s, dt_s, dtheta_x_rad .. dtheta_z_rad, dv_x_mps .. dv_z_mps: lossless
  kKfGins,         ///< no header, blanks between: seconds of week, dtheta xyz (rad), dv xyz (m/s)
};
constexpr auto names(ImuLogFormat) {
  return std::array{"CSV, rates", "CSV, increments", "KF-GINS text"};
}

struct ImuLogOptions {
  RateMeaning meaning{RateMeaning::kPoint};           ///< of kCsvRates
  Eigen::Matrix3d C_bs{Eigen::Matrix3d::Identity()};  ///< sensor axes to body axes
};

/// Streams a plain or gzip log in constant memory. A damaged line costs that line: unparsable, a
/// number missing or not finite, an angular rate beyond 1e3 rad/s (or rad), a specific force beyond
/// 1e5 m/s^2 (or m/s), a time that goes back, repeats or jumps ahead of the lines after it.
/// Repeated values under new times are passed on as they are.
class ImuLogReader {
 public:
  /// @throws Error when the file cannot be read, is empty, lacks columns (naming them), or C_bs is
  /// not a proper rotation to 1e-6.
  explicit ImuLogReader(const std::filesystem::path& path, const ImuLogOptions& options = {});
  ~ImuLogReader();
  ImuLogReader(ImuLogReader&&) noexcept;
  ImuLogReader& operator=(ImuLogReader&&) noexcept;

  /// The next increment, in body axes, its time later than the one before; nothing at the end. In
  /// layouts without dt_s it is the time from the line before and the first line only starts the
  /// clock. Over a gap of rates the increment is a fiction: judge it by its dt_s.
  /// Seconds of week (kKfGins) count on past the end of the week.
  std::optional<ImuIncrement> next();

  ImuLogFormat format() const;
  const LogSummary& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes the kCsvIncrements layout: every number reads back bit for bit. Errors and the partial
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
