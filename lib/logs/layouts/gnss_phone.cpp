#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "leeway/earth/rotation.hpp"
#include "lib/logs/layouts/gnss_layouts.hpp"

namespace leeway {
namespace {

constexpr std::array kPhonePlace{NamedColumn{"t_s", kTimeColumn},
                                 NamedColumn{"lat_deg", {0, -90.0, 90.0}},
                                 NamedColumn{"lon_deg", {1, -360.0, 360.0}},
                                 NamedColumn{"height_m", {2, -kMaxHeightM, kMaxHeightM}},
                                 NamedColumn{"horizontal_accuracy_m", {3, -kMaxSigma, kMaxSigma}}};
constexpr std::array kPhoneOthers{
    NamedColumn{"vertical_accuracy_m", {4, -kMaxSigma, kMaxSigma, true}},
    NamedColumn{"speed_mps", velocity_column(5)},
    NamedColumn{"course_deg", {6, -360.0, 360.0, true}},
    NamedColumn{"speed_accuracy_mps", {7, -kMaxSigma, kMaxSigma, true}},
    NamedColumn{"course_accuracy_deg", {8, -360.0, 360.0, true}}};
constexpr std::size_t kPhoneSlots = 9;

// Within the accuracy of a phone 68 % of the places are expected. Source: Android API reference,
// Location.getAccuracy. Of a circle, that is this many standard deviations of one axis.
const double kSigmasOfCircle = std::sqrt(-2.0 * std::log(1.0 - 0.68));
// What is not measured: a phone tells no vertical velocity.
constexpr double kNoVelocitySigmaMps = 100.0;

/// A negative number, and an absent one, say that there is none.
bool is_told(double value) { return value > 0.0; }

struct PhoneFixParser {
  LineParser fields{};
  std::size_t told_sigmas{0};  ///< LogFormat::gnss_sigma, which replaces the log's

  std::optional<Fault> operator()(std::string_view line, GnssFix& fix) const {
    std::array<double, kPhoneSlots> v{};
    std::fill(v.begin() + 4, v.end(), std::numeric_limits<double>::quiet_NaN());
    Time time{};
    if (auto fault = fields.parse(line, time, v)) return fault;
    if (told_sigmas > 0) v[3] = v[4] = 1.0;
    if (told_sigmas == 4) v[7] = v[8] = 1.0;
    if (!is_told(v[3]) || !is_told(v[4])) return kNoRow;
    fix = GnssFix{.time = time};
    const Geodetic place{v[0] * kRadPerDeg, v[1] * kRadPerDeg, v[2]};
    const double horizontal_m = v[3] / kSigmasOfCircle;
    const Eigen::Vector3d sigma_m(horizontal_m, horizontal_m, v[4]);
    fix.position =
        GnssPosition::from_geodetic(place, sigma_m.cwiseAbs2().asDiagonal().toDenseMatrix());
    if (v[5] >= 0.0 && v[6] >= 0.0 && is_told(v[7]) && is_told(v[8])) {
      fix.velocity = velocity_of(place, v[5], v[6] * kRadPerDeg, v[7], v[8] * kRadPerDeg);
    }
    return std::nullopt;
  }

  static GnssVelocity velocity_of(const Geodetic& place, double speed_mps, double course_rad,
                                  double speed_sigma_mps, double course_sigma_rad) {
    Eigen::Matrix3d C_nt = Eigen::Matrix3d::Identity();  // along the course, across, down
    C_nt.topLeftCorner<2, 2>() << std::cos(course_rad), -std::sin(course_rad), std::sin(course_rad),
        std::cos(course_rad);
    const double across_mps = std::hypot(speed_sigma_mps, speed_mps * course_sigma_rad);
    const Eigen::Vector3d sigma_mps(speed_sigma_mps, across_mps, kNoVelocitySigmaMps);
    return GnssVelocity::from_ned(place, C_nt.col(0) * speed_mps,
                                  C_nt * sigma_mps.cwiseAbs2().asDiagonal() * C_nt.transpose());
  }
};

/// Sensor Logger gives heights above the ellipsoid as altitude, and heads its own time so.
LogFormat format_of_phone(const LogOpening& log) {
  LogFormat format = log.format;
  const bool is_sensor_logger = log.head.line.find("seconds_elapsed") != std::string::npos;
  if (is_sensor_logger) format.columns.emplace("height", "altitude");
  return format;
}

bool is_phone_location(const LogOpening& log) {
  const CsvHeader header = CsvHeader::understood(log.head.line, "", format_of_phone(log));
  return header.has(kPhonePlace) && !header.has(kPositionColumns);
}

RowParser<GnssFix> phone_fix_parser(LogOpening& log) {
  const LogFormat format = format_of_phone(log);
  LogOpening with_names{log.head, log.lines, format, log.notes, {}};
  CsvHeader header = take_csv_header(with_names, kPhonePlace, list_of(gnss_layouts()));
  header.use(kPhoneOthers);
  header.note(log.notes);
  if (!header.has(kPhoneOthers) && log.format.gnss_sigma.size() < 4) {
    log.notes.push_back(
        "speed and course without accuracies are not used: say --gnss-sigma H,V,VH,VV");
  }
  return PhoneFixParser{header.parser(), log.format.gnss_sigma.size()};
}

}  // namespace

GnssLayout gnss_phone() {
  return {"phone location", "one of a phone with " + join(kPhonePlace), is_phone_location,
          phone_fix_parser};
}

}  // namespace leeway
