/// @file
/// What a log does not say of itself: its layout, the names of its columns, its units.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace leeway {

/// Said of a log by its owner. Empty: the reader tells it from the content.
struct LogFormat {
  std::string layout{};      ///< name of the layout, in place of recognizing it
  std::string time_unit{};   ///< "s", "ms", "us", "ns"
  std::string gyro_unit{};   ///< of rates in CSV: "rad/s", "deg/s", "mdps"
  std::string accel_unit{};  ///< of specific force in CSV: "m/s^2", "g", "mg"
  /// Names in a CSV by Leeway's: {"gx_radps", "wx"}. The unit may be left out: {"gx", "wx"}. A "-"
  /// before the name turns the sign: {"vd", "-v_up"}.
  std::map<std::string, std::string> columns{};

  /// Where x, y, z of the IMU's axes point, a letter each of forward, back, right, left, up, down:
  /// "frd", "flu", "rfu"; also "enu" for rfu and "ned" for frd.
  std::string axes{};
  /// Standard deviations in place of those of a GNSS log: of position, horizontal and vertical (m),
  /// and, or not, of velocity (m/s). Two or four.
  std::vector<double> gnss_sigma{};

  bool operator==(const LogFormat&) const = default;
};

/// The names that LogFormat::columns may have: gx and gx_radps, lat and lat_deg, ..
std::vector<std::string> log_column_names();

}  // namespace leeway
