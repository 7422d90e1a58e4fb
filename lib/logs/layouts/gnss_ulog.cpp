#include <array>
#include <cmath>

#include "lib/logs/layouts/gnss_layouts.hpp"
#include "lib/logs/layouts/receiver_fix.hpp"
#include "lib/logs/messages/ulog.hpp"

namespace leeway {
namespace {

/// The places of the numbers in kGpsNumbers.
enum GpsNumber {
  kGpsTimestamp,
  kGpsSample,
  kGpsLatE7,
  kGpsLonE7,
  kGpsHeightMm,
  kGpsLatDeg,
  kGpsLonDeg,
  kGpsHeightM,
  kGpsEph,
  kGpsEpv,
  kGpsSpeedAccuracy,
  kGpsVn,
  kGpsVe,
  kGpsVd,
  kGpsVelocityValid,
  kGpsFixType,
  kGpsNumberCount
};
// Until PX4 1.13 places are whole numbers of 1e-7 deg and of mm. The accuracies are those of the
// receiver: eph of north and east together, s_variance_m_s of three axes, neither of them squared.
constexpr std::array<UlogNumber, kGpsNumberCount> kGpsNumbers{UlogNumber{"timestamp"},
                                                              UlogNumber{"timestamp_sample"},
                                                              UlogNumber{"lat"},
                                                              UlogNumber{"lon"},
                                                              UlogNumber{"alt_ellipsoid"},
                                                              UlogNumber{"latitude_deg"},
                                                              UlogNumber{"longitude_deg"},
                                                              UlogNumber{"altitude_ellipsoid_m"},
                                                              UlogNumber{"eph"},
                                                              UlogNumber{"epv"},
                                                              UlogNumber{"s_variance_m_s"},
                                                              UlogNumber{"vel_n_m_s"},
                                                              UlogNumber{"vel_e_m_s"},
                                                              UlogNumber{"vel_d_m_s"},
                                                              UlogNumber{"vel_ned_valid"},
                                                              UlogNumber{"fix_type"}};

using GpsNumbers = std::array<double, kGpsNumberCount>;

/// Three dimensions, measured: type 8 is extrapolated.
bool is_fix_of_ulog(double type) { return type >= 3.0 && type != 8.0; }

Geodetic place_of_ulog(const GpsNumbers& n) {
  const bool is_old = std::isnan(n[kGpsLatDeg]);
  const double lat_deg = is_old ? n[kGpsLatE7] * 1e-7 : n[kGpsLatDeg];
  const double lon_deg = is_old ? n[kGpsLonE7] * 1e-7 : n[kGpsLonDeg];
  return {lat_deg * kRadPerDeg, lon_deg * kRadPerDeg,
          is_old ? n[kGpsHeightMm] * 1e-3 : n[kGpsHeightM]};
}

/// Fixes of vehicle_gps_position; of sensor_gps in a log without it.
class UlogFixParser {
 public:
  std::optional<Fault> operator()(std::string_view message, GnssFix& fix) {
    if (message.empty()) return end();
    const UlogTopic& topic = vehicle_.is_logged() ? vehicle_ : sensor_;
    if (!topic.is_of(message)) {
      if (is_ulog_head(message)) return kNoRow;
      vehicle_.learn(message);
      sensor_.learn(message);
      return kNoRow;
    }
    GpsNumbers numbers{};
    if (!topic.read(message, numbers)) return Fault{LineDamage::kCutShort, "position of the GPS"};
    return is_fix_of_ulog(numbers[kGpsFixType]) ? fix_of(numbers, fix) : std::optional(kNoRow);
  }

 private:
  static std::optional<Fault> fix_of(const GpsNumbers& n, GnssFix& fix) {
    const Geodetic place = place_of_ulog(n);
    if (!(std::abs(place.lat_rad) <= 90.0 * kRadPerDeg)) {
      return Fault{LineDamage::kOutOfRange, "latitude"};
    }
    if (!(std::abs(place.lon_rad) <= 360.0 * kRadPerDeg)) {
      return Fault{LineDamage::kOutOfRange, "longitude"};
    }
    const double time_us = n[kGpsSample] > 0.0 ? n[kGpsSample] : n[kGpsTimestamp];
    if (!(time_us >= 0.0 && time_us < kMostUlogUs))
      return Fault{LineDamage::kOutOfRange, "timestamp"};
    std::optional<Eigen::Vector3d> v_n_mps;
    if (n[kGpsVelocityValid] > 0.0 && n[kGpsSpeedAccuracy] > 0.0) {
      v_n_mps.emplace(n[kGpsVn], n[kGpsVe], n[kGpsVd]);
    }
    fix = receiver_fix(Time{std::chrono::microseconds{static_cast<std::int64_t>(time_us)}}, place,
                       v_n_mps, {n[kGpsEph], n[kGpsEpv], n[kGpsSpeedAccuracy]});
    return std::nullopt;
  }

  std::optional<Fault> end() const {
    if (vehicle_.is_logged() || sensor_.is_logged()) return kNoRow;
    return Fault{LineDamage::kMissingField,
                 "topic vehicle_gps_position or sensor_gps, one of which must be logged"};
  }

  UlogTopic vehicle_{"vehicle_gps_position", kGpsNumbers};
  UlogTopic sensor_{"sensor_gps", kGpsNumbers};
};

RowParser<GnssFix> ulog_fix_parser(LogOpening& log) {
  log.framing = ulog_frame;
  return UlogFixParser{};
}

}  // namespace

GnssLayout gnss_ulog() {
  return {"PX4 ULog", "PX4 ULog with vehicle_gps_position or sensor_gps", is_ulog, ulog_fix_parser,
          true};
}

}  // namespace leeway
