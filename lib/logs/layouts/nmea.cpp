#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "lib/earth/calendar.hpp"
#include "lib/logs/layouts/gnss_layouts.hpp"

namespace leeway {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kMpsPerKnot = 1852.0 / 3600.0;
constexpr Duration kNmeaDay = std::chrono::hours{24};

using Words = std::vector<std::string_view>;

/// A number that fills its field; NaN for any other.
double decimal(std::string_view text) {
  double value = kNone;
  const auto [after, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && after == text.data() + text.size() ? value : kNone;
}

/// Two digits at a place of the text; -1 where there are none.
int two_digits(std::string_view text, std::size_t at) {
  int value = -1;
  if (at + 2 > text.size()) return -1;
  const auto [after, error] = std::from_chars(text.data() + at, text.data() + at + 2, value);
  return error == std::errc{} && after == text.data() + at + 2 ? value : -1;
}

/// "hhmmss.ss" since midnight, UTC.
std::optional<Duration> time_of_day(std::string_view text) {
  const int hour = two_digits(text, 0), minute = two_digits(text, 2);
  Time seconds{};
  const char* p = text.data() + std::min<std::size_t>(4, text.size());
  const char* const end = text.data() + text.size();
  const bool is_read = p != end && !parse_time(p, end, seconds) && p == end;
  if (!is_read || hour < 0 || hour > 23 || minute < 0 || minute > 59) return std::nullopt;
  if (seconds >= time_from_seconds(61.0)) return std::nullopt;
  return std::chrono::hours{hour} + std::chrono::minutes{minute} + seconds.time_since_epoch();
}

/// "ddmmyy" since the epoch of GPS.
std::optional<Duration> date_of(std::string_view text) {
  const int year = two_digits(text, 4);
  if (text.size() != 6 || year < 0) return std::nullopt;
  return day_since_gps_epoch(year < 80 ? 2000 + year : 1900 + year, two_digits(text, 2),
                             two_digits(text, 0));
}

/// "dddmm.mmmm" and its hemisphere, deg.
double angle_of(std::string_view text, std::string_view hemisphere) {
  const double value = decimal(text);
  const double degrees = std::floor(value / 100.0);
  const double angle = degrees + (value - 100.0 * degrees) / 60.0;
  if (hemisphere == "N" || hemisphere == "E") return angle;
  return hemisphere == "S" || hemisphere == "W" ? -angle : kNone;
}

/// Whether the checksum behind '*' is that of what stands between it and '$'.
bool has_right_checksum(std::string_view line) {
  const std::size_t star = line.rfind('*');
  if (star == std::string_view::npos || line.size() < star + 3) return false;
  unsigned char sum = 0;
  for (const char c : line.substr(1, star - 1)) sum ^= static_cast<unsigned char>(c);
  int told = -1;
  const char* const digits = line.data() + star + 1;
  const auto [after, error] = std::from_chars(digits, digits + 2, told, 16);
  return error == std::errc{} && after == digits + 2 && told == sum;
}

/// What the sentences of one time of day say.
struct NmeaEpoch {
  std::optional<Duration> time_of_day{};
  std::array<double, 3> place{kNone, kNone, kNone};  ///< deg, deg, m
  std::array<double, 3> sigma{kNone, kNone, kNone};  ///< m
  double speed_mps{kNone};
  double course_deg{kNone};
};

/// Sentences of any talker, put together by their time of day. The day is that of RMC.
class NmeaParser {
 public:
  explicit NmeaParser(std::vector<double> told_sigmas) : told_(std::move(told_sigmas)) {}

  std::optional<Fault> operator()(std::string_view line, GnssFix& fix) {
    if (line.empty()) return finish(fix) ? std::nullopt : std::optional(kNoRow);
    if (line.front() != '$' || !has_right_checksum(line)) return Fault{LineDamage::kChecksum, line};
    const Words words = split_fields(line.substr(0, line.rfind('*')), Separator::kComma);
    if (words[0].size() != 6) return kNoRow;
    const std::string_view kind = words[0].substr(3);
    if (kind == "VTG" && words.size() > 5) set_motion(words[5], words[1]);
    const bool is_timed = (kind == "GGA" && words.size() > 11) ||
                          (kind == "RMC" && words.size() > 9) ||
                          (kind == "GST" && words.size() > 8);
    if (!is_timed || words[1].empty()) return kNoRow;
    const auto time = time_of_day(words[1]);
    if (!time) return Fault{LineDamage::kNotANumber, words[1]};
    const bool is_new = epoch_.time_of_day != time;
    const bool is_complete = is_new && finish(fix);
    if (is_new) begin(*time);
    take(kind, words);
    return is_complete ? std::nullopt : std::optional(kNoRow);
  }

 private:
  void begin(Duration time) {
    const bool is_next_day = last_ && time < *last_ - kNmeaDay / 2;
    if (day_ && is_next_day) *day_ += kNmeaDay;
    last_ = time;
    epoch_ = {.time_of_day = time};
  }

  void take(std::string_view kind, const Words& words) {
    if (kind == "GGA" && words[6] != "0") {
      epoch_.place = {angle_of(words[2], words[3]), angle_of(words[4], words[5]),
                      decimal(words[9]) + decimal(words[11])};
    } else if (kind == "GST") {
      epoch_.sigma = {decimal(words[6]), decimal(words[7]), decimal(words[8])};
    } else if (kind == "RMC") {
      if (const auto day = date_of(words[9])) day_ = day;
      if (words[2] == "A") set_motion(words[7], words[8]);
    }
  }

  void set_motion(std::string_view knots, std::string_view course) {
    epoch_.speed_mps = decimal(knots) * kMpsPerKnot;
    // A receiver at rest gives no course.
    epoch_.course_deg = course.empty() && epoch_.speed_mps < 0.1 ? 0.0 : decimal(course);
  }

  /// The fix of the epoch, where it has one.
  bool finish(GnssFix& fix) {
    const NmeaEpoch epoch = std::exchange(epoch_, {});
    if (!epoch.time_of_day || !day_) return false;
    const auto& [lat_deg, lon_deg, height_m] = epoch.place;
    Eigen::Vector3d sigma_m(epoch.sigma.data());
    if (!told_.empty()) sigma_m = {told_[0], told_[0], told_[1]};
    const bool is_place = std::abs(lat_deg) <= 90.0 && std::abs(lon_deg) <= 360.0;
    if (!is_place || !std::isfinite(height_m) || !(sigma_m.array() > 0.0).all()) return false;
    fix = GnssFix{};
    const Duration utc = *day_ + *epoch.time_of_day;
    fix.time = Time{utc + gps_minus_utc(utc)};
    const Geodetic place{lat_deg * kRadPerDeg, lon_deg * kRadPerDeg, height_m};
    fix.position =
        GnssPosition::from_geodetic(place, sigma_m.cwiseAbs2().asDiagonal().toDenseMatrix());
    const double course_rad = epoch.course_deg * kRadPerDeg;
    const Eigen::Vector3d v_n(epoch.speed_mps * std::cos(course_rad),
                              epoch.speed_mps * std::sin(course_rad), 0.0);
    if (told_.size() == 4 && v_n.allFinite()) {
      const Eigen::Vector3d sigma_mps(told_[2], told_[2], told_[3]);
      fix.velocity =
          GnssVelocity::from_ned(place, v_n, sigma_mps.cwiseAbs2().asDiagonal().toDenseMatrix());
    }
    return true;
  }

  std::vector<double> told_;
  NmeaEpoch epoch_{};
  std::optional<Duration> day_{};   // since the epoch of GPS, UTC
  std::optional<Duration> last_{};  // time of day of the newest epoch
};

bool is_nmea(const LogOpening& log) {
  const std::string& line = log.head.line;
  return line.starts_with('$') && line.find(',') != std::string::npos;
}

RowParser<GnssFix> nmea_parser(LogOpening& log) {
  const std::vector<double>& told = log.format.gnss_sigma;
  if (told.empty() && log.lines.preview().find("GST,") == std::string_view::npos) {
    throw Error(log.lines.path() +
                ": NMEA without GST sentences has no standard deviations: say --gnss-sigma H,V, "
                "or H,V,VH,VV to use its speed and course as well");
  }
  if (log.lines.preview().find("RMC,") == std::string_view::npos) {
    throw Error(log.lines.path() +
                ": NMEA without RMC sentences has no date: switch RMC on in the receiver");
  }
  if (told.size() < 4) {
    log.notes.push_back(
        "NMEA gives no standard deviation of velocity, so speed and course are not used: say "
        "--gnss-sigma H,V,VH,VV; its vertical velocity is then taken to be 0 within VV");
  }
  return NmeaParser{told};
}

}  // namespace

GnssLayout nmea() { return {"NMEA 0183", "NMEA 0183 with GGA, RMC and GST", is_nmea, nmea_parser}; }

}  // namespace leeway
