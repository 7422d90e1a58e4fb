/// @file
/// GNSS logs: a streaming reader of many layouts and the writer of one.
#pragma once

#include <filesystem>

#include "leeway/earth/names.hpp"
#include "leeway/logs/csv_writer.hpp"
#include "leeway/logs/log_format.hpp"
#include "leeway/logs/log_reader.hpp"
#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// How a GNSS log is read.
struct GnssLogOptions {
  double position_sigma_scale{1.0};  ///< multiplies the log's standard deviations
  double velocity_sigma_scale{1.0};
  Duration time_offset{0};  ///< added to every time, to put the log on the time line of the IMU's
  LogFormat format{};
};

/// A reader of GNSS logs, plain or gzip, in constant memory. The layout is told from the content:
///
/// - "CSV" of any dialect, columns found by name or an alias (docs/guide/log-formats.md) in any
///   order, further ones noted in the summary: t_s, lat_deg, lon_deg,
///   height_m (ellipsoidal), pos_std_n_m, pos_std_e_m, pos_std_d_m; and all or none of vn_mps,
///   ve_mps, vd_mps, vel_std_n_mps, vel_std_e_mps, vel_std_d_mps. A row with an empty or NaN
///   velocity field has no velocity. Where heading_deg and heading_sigma_deg both are columns, a
///   fix has a heading, of the body's x axis clockwise from true north. A row with an empty or NaN
///   heading, or a zero sigma, has none; an empty sigma is 2 deg.
/// - "KF-GINS text": blanks between, no header: seconds of week, latitude and longitude (deg),
///   height (m), standard deviations north, east, down (m); then, or not, velocity and its
///   deviations (m/s), NED.
/// - "RTKLIB .pos": latitude, longitude, height (degrees or d m s) or x/y/z, with covariances. Its
///   time is GPS time since 1980-01-06; UTC and JST are converted. Without a header, GPS time.
///   Velocities without standard deviations, or with zeros for them, are not used. Where the
///   printed correlations are rounded beyond a positive definite matrix, only its diagonal is used.
/// - "u-blox UBX": NAV-PVT, with the place of NAV-HPPOSLLH where it is there. Accuracies of several
///   axes together are shared evenly among them. What the receiver refuses itself is no fix.
/// - "phone location": of Sensor Logger or phyphox; of a folder it is Location.csv.
/// - "PX4 ULog": vehicle_gps_position, or sensor_gps in a log without it; times since the start of
///   the system.
///
/// A damaged line costs that line: one that cannot be parsed, with a number missing or not finite,
/// a latitude beyond +-90 deg or a longitude beyond +-360 deg. So does a standard deviation not in
/// (0, 1e5] and a fix that is not usable (is_usable). So does a time that goes back, repeats or
/// jumps ahead of the lines after it.
class GnssLogReader : public LogReader<GnssFix> {
 public:
  /// @throws Error when the file cannot be read, is empty or lacks columns (naming them), or a
  /// scale is not a positive number. Also when positions are not ellipsoidal WGS-84, naming the
  /// RTKLIB option to change.
  explicit GnssLogReader(const std::filesystem::path& path, const GnssLogOptions& options = {});
};

/// Writer of the CSV layout with velocity columns. Geodetic position, NED velocity and standard
/// deviations are exact; the layout has no correlations, and headings are not written. Errors and
/// the partial file are those of CsvWriter.
class GnssLogWriter {
 public:
  explicit GnssLogWriter(const std::filesystem::path& path);

  /// Row of a fix; NaN where it has no velocity. @throws Error when it has no position.
  void write(const GnssFix& fix);
  void close() { csv_.close(); }

 private:
  CsvWriter csv_;
};

}  // namespace leeway
