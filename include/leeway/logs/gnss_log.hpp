/// @file
/// GNSS logs: a streaming reader of three layouts and the writer of one.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "leeway/earth/names.hpp"
#include "leeway/logs/csv_writer.hpp"
#include "leeway/logs/log_summary.hpp"
#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// Told from the content of the file.
enum class GnssLogFormat {
  /// CSV, columns found by name in any order, further columns ignored: t_s, lat_deg, lon_deg,
  /// height_m (ellipsoidal), pos_std_n_m, pos_std_e_m, pos_std_d_m, and all or none of vn_mps,
  /// ve_mps, vd_mps, vel_std_n_mps, vel_std_e_mps, vel_std_d_mps. A row with an empty or NaN
  /// velocity field has no velocity.
  kCsv,
  /// Blanks between, no header: seconds of week, latitude and longitude (deg), height (m), standard
  /// deviations north, east, down (m); then, or not, velocity and its deviations (m/s), NED.
  kKfGins,
  /// RTKLIB .pos: latitude, longitude, height (degrees or d m s) or x/y/z, with its covariances.
  /// Its
  /// time is GPS time since 1980-01-06; UTC and JST are converted with 18 leap seconds, right from
  /// 2017-01-01, and earlier dates in them are out of range. Velocities without standard
  /// deviations,
  /// or with zeros for them, are not used. Where the printed correlations are rounded beyond a
  /// positive definite matrix only its diagonal is used.
  kRtklib,
};
constexpr auto names(GnssLogFormat) { return std::array{"CSV", "KF-GINS text", "RTKLIB .pos"}; }

struct GnssLogOptions {
  double position_sigma_scale{1.0};  ///< multiplies the log's standard deviations
  double velocity_sigma_scale{1.0};
  Duration time_offset{0};  ///< added to every time, to put the log on the time line of the IMU's
};

/// Streams a plain or gzip log in constant memory. A damaged line costs that line: unparsable, a
/// number missing or not finite, a latitude beyond +-90 deg, a longitude beyond +-360 deg, a
/// standard deviation not in (0, 1e5], a fix that is not usable (is_usable), a time that goes back,
/// repeats or jumps ahead of the lines after it.
class GnssLogReader {
 public:
  /// @throws Error when the file cannot be read, is empty, lacks columns (naming them), holds
  /// something else than ellipsoidal WGS-84 positions (naming the RTKLIB option to change), or a
  /// scale is not a positive number.
  explicit GnssLogReader(const std::filesystem::path& path, const GnssLogOptions& options = {});
  ~GnssLogReader();
  GnssLogReader(GnssLogReader&&) noexcept;
  GnssLogReader& operator=(GnssLogReader&&) noexcept;

  /// The next usable fix, later than the one before; nothing at the end.
  std::optional<GnssFix> next();

  GnssLogFormat format() const;
  const LogSummary& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Writes the kCsv layout with velocity columns: exact numbers of the geodetic position, of the NED
/// velocity and of the standard deviations; the layout has no correlations. Errors and the partial
/// file are those of CsvWriter.
class GnssLogWriter {
 public:
  explicit GnssLogWriter(const std::filesystem::path& path);

  /// A fix without velocity has NaN there. @throws Error when the fix has no position.
  void write(const GnssFix& fix);
  void close() { csv_.close(); }

 private:
  CsvWriter csv_;
};

}  // namespace leeway
