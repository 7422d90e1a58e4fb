#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "lib/earth/calendar.hpp"
#include "lib/logs/layouts/gnss_layouts.hpp"

namespace leeway {
namespace {

using namespace std::chrono_literals;

// Slots: three components each; covariances in the file's order.
enum Slot {
  kPosition = 0,
  kSigma = 3,
  kCovariance = 6,
  kVelocity = 9,
  kVelocitySigma = 12,
  kVelocityCovariance = 15,
  kMinutes = 18,
  kSeconds = 20,
  kRtklibSlots = 22
};

/// Columns by their slots, and the limits of the coordinates.
struct Frame {
  std::array<std::string_view, kMinutes> names;
  std::array<double, 3> limits;
};
constexpr Frame kGeodetic{
    {"latitude", "longitude", "height", "sdn", "sde", "sdu", "sdne", "sdeu", "sdun", "vn", "ve",
     "vu", "sdvn", "sdve", "sdvu", "sdvne", "sdveu", "sdvun"},
    {90.0, 360.0, kMaxHeightM}};
constexpr Frame kEcef{{"x-ecef", "y-ecef", "z-ecef", "sdx", "sdy", "sdz", "sdxy", "sdyz", "sdzx",
                       "vx", "vy", "vz", "sdvx", "sdvy", "sdvz", "sdvxy", "sdvyz", "sdvzx"},
                      {1e7, 1e7, 1e7}};

constexpr Column optional(int slot) { return {slot, -kMaxSigma, kMaxSigma, true}; }

/// The columns of the slots from the first to before the last.
std::vector<NamedColumn> columns_of(const Frame& frame, int first, int last) {
  std::vector<NamedColumn> columns;
  for (int slot = first; slot < last; ++slot) {
    const auto at = static_cast<std::size_t>(slot);
    Column column = slot < kCovariance ? sigma_column(slot) : optional(slot);
    if (slot < kSigma) column = {slot, -frame.limits[at], frame.limits[at]};
    columns.push_back({frame.names[at], column});
  }
  return columns;
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

Eigen::Vector3d vector_at(std::span<const double> values, int slot) {
  return Eigen::Map<const Eigen::Vector3d>(values.data() + slot);
}

// RTKLIB prints a covariance as its square root with the covariance's sign.
double signed_square(double value) { return std::copysign(value * value, value); }

// Three standard deviations and the covariances 01, 12, 20 of the same axes.
Eigen::Matrix3d covariance(std::span<const double> values, int sigma_slot, int covariance_slot) {
  const Eigen::Matrix3d R = vector_at(values, sigma_slot).cwiseAbs2().asDiagonal();
  const Eigen::Vector3d c = vector_at(values, covariance_slot).unaryExpr(&signed_square);
  if (!c.allFinite()) return R;
  Eigen::Matrix3d full = R;
  full(0, 1) = full(1, 0) = c[0];
  full(1, 2) = full(2, 1) = c[1];
  full(2, 0) = full(0, 2) = c[2];
  return full.llt().info() == Eigen::Success ? full : R;
}

bool has_velocity(std::span<const double> values) {
  return vector_at(values, kVelocity).allFinite() &&
         (vector_at(values, kVelocitySigma).array() > 0.0).all();
}

double degrees(std::span<const double> values, int axis) {
  const auto at = [&](int slot) { return values[static_cast<std::size_t>(slot + axis)]; };
  const double magnitude = std::abs(at(kPosition)) + at(kMinutes) / 60.0 + at(kSeconds) / 3600.0;
  return std::copysign(magnitude, at(kPosition));  // the sign of -0 33 00 is on the zero
}

void set_from_ecef(std::span<const double> values, GnssFix& fix) {
  fix.position =
      GnssPosition{vector_at(values, kPosition), covariance(values, kSigma, kCovariance)};
  fix.velocity.reset();
  if (!has_velocity(values)) return;
  fix.velocity = GnssVelocity{vector_at(values, kVelocity),
                              covariance(values, kVelocitySigma, kVelocityCovariance)};
}

void set_from_geodetic(std::span<const double> values, GnssFix& fix) {
  const Geodetic place{degrees(values, 0) * kRadPerDeg, degrees(values, 1) * kRadPerDeg,
                       values[kPosition + 2]};
  const Eigen::Matrix3d C_nu = Eigen::Vector3d(1.0, 1.0, -1.0).asDiagonal();  // u: north-east-up
  fix.position =
      GnssPosition::from_geodetic(place, C_nu * covariance(values, kSigma, kCovariance) * C_nu);
  fix.velocity.reset();
  if (!has_velocity(values)) return;
  fix.velocity =
      GnssVelocity::from_ned(place, C_nu * vector_at(values, kVelocity),
                             C_nu * covariance(values, kVelocitySigma, kVelocityCovariance) * C_nu);
}

bool is_separator(char c) { return c == ' ' || c == ',' || c == ';' || c == '\t'; }

const char* skip_separators(const char* p, const char* end) {
  return std::find_if_not(p, end, is_separator);
}

// A whole number and the character behind it; false when either is missing.
bool parse_part(const char*& p, const char* end, char behind, int& value) {
  p = std::find_if_not(p, end, [](char c) { return c == ' '; });
  const auto [after, error] = std::from_chars(p, end, value);
  if (error != std::errc{} || after == end || *after != behind) return false;
  p = after + 1;
  return true;
}

// "yyyy/mm/dd hh:mm:" from the year on, as the time since the epoch of GPS.
std::optional<LineDamage> parse_date(const char*& p, const char* end, int year, Duration& time) {
  int month = 0, day = 0, hour = 0, minute = 0;
  if (!parse_part(p, end, '/', month) || !parse_part(p, end, ' ', day) ||
      !parse_part(p, end, ':', hour) || !parse_part(p, end, ':', minute)) {
    return LineDamage::kNotANumber;
  }
  const auto date = day_since_gps_epoch(year, month, day);
  if (!date) return LineDamage::kOutOfRange;
  if (hour < 0 || hour > 23 || minute < 0 || minute > 59) return LineDamage::kOutOfRange;
  time = *date + std::chrono::hours{hour} + std::chrono::minutes{minute};
  return std::nullopt;
}

// The part of an epoch before its seconds: a date with hours and minutes, or a GPS week.
std::optional<LineDamage> parse_day_or_week(const char*& p, const char* end, Duration& time) {
  int number = 0;
  const auto [after, error] = std::from_chars(p, end, number);
  if (error != std::errc{} || after == end) return LineDamage::kNotANumber;
  p = after + 1;
  if (*after == '/') return parse_date(p, end, number, time);
  if (!is_separator(*after)) return LineDamage::kNotANumber;
  if (number < 0 || number > kLastGpsWeek) return LineDamage::kOutOfRange;
  time = std::chrono::weeks{number};
  return std::nullopt;
}

/// Field names, time system and options are told by the lines that start with '%'.
/// Source: RTKLIB ver. 2.4.2 Manual, appendix B.1.
class RtklibParser {
 public:
  /// @throws Error on an e/n/u baseline, a geodetic height or a datum other than WGS-84, or a
  /// column header without a position and its standard deviations.
  void read_header(std::string_view line, const std::string& path);

  bool has_columns() const { return has_columns_; }

  std::optional<Fault> operator()(std::string_view line, GnssFix& fix) const;

 private:
  void read_columns(std::string_view line, const std::string& path);
  std::optional<Fault> parse_epoch(std::string_view& line, Time& time) const;

  LineParser fields_{};
  Duration to_utc_{0};  // from the log's calendar, where it is not that of GPS
  bool is_utc_{false};
  bool is_ecef_{false};
  bool has_columns_{false};
};

void RtklibParser::read_header(std::string_view line, const std::string& path) {
  if (contains(line, "baseline=") || contains(line, "e-baseline(")) {
    throw Error(path +
                ": holds an e/n/u baseline; set the RTKLIB option out-solformat to llh or xyz");
  }
  if (contains(line, "lat/lon/height=") && !contains(line, "=WGS84/ellipsoidal")) {
    throw Error(path +
                ": its positions are not WGS-84 with ellipsoidal height; set the RTKLIB "
                "option out-height to ellipsoidal");
  }
  if (contains(line, "latitude(") || contains(line, "x-ecef(")) read_columns(line, path);
}

void RtklibParser::read_columns(std::string_view line, const std::string& path) {
  auto titles = split_fields(line.substr(line.find('%') + 1), Separator::kRuns);
  is_utc_ = titles.front() == "UTC" || titles.front() == "JST";
  if (titles.front() == "JST") to_utc_ = -9h;
  is_ecef_ = contains(line, "x-ecef(");
  const bool is_dms = contains(line, "latitude(d'");
  // The names without their units, as a CSV header whose fields parse() then finds.
  std::string names;
  for (auto title = titles.begin() + 1; title != titles.end(); ++title) {
    const std::string name(title->substr(0, title->find('(')));
    names += name + ",";
    if (is_dms && name.ends_with("itude")) names += name + "_min," + name + "_s,";
  }
  CsvHeader header(names, path);
  const Frame& frame = is_ecef_ ? kEcef : kGeodetic;
  const auto needed = columns_of(frame, kPosition, kCovariance);
  header.require(needed, "an RTKLIB header with " + join(needed));
  header.use(columns_of(frame, kCovariance, kMinutes));
  // RTKLIB heads the last covariance of a d m s layout "sdue" by mistake.
  header.use(std::array{NamedColumn{"sdue", optional(kCovariance + 2)}});
  if (is_dms) {
    header.use(std::array{NamedColumn{"latitude_min", {kMinutes, 0.0, 60.0}},
                          NamedColumn{"latitude_s", {kSeconds, 0.0, 60.0}},
                          NamedColumn{"longitude_min", {kMinutes + 1, 0.0, 60.0}},
                          NamedColumn{"longitude_s", {kSeconds + 1, 0.0, 60.0}}});
  }
  fields_ = header.parser(Separator::kRuns);
  has_columns_ = true;
}

std::optional<Fault> RtklibParser::operator()(std::string_view line, GnssFix& fix) const {
  if (auto fault = parse_epoch(line, fix.time)) return fault;
  std::array<double, kRtklibSlots>
      values{};  // minutes and seconds stay zero where degrees are decimal
  std::fill(values.begin() + kCovariance, values.begin() + kMinutes,
            std::numeric_limits<double>::quiet_NaN());
  Time unused{};
  if (auto fault = fields_.parse(line, unused, values)) return fault;
  if (is_ecef_) {
    set_from_ecef(values, fix);
  } else {
    set_from_geodetic(values, fix);
  }
  return std::nullopt;
}

// On success the line goes on behind its time.
std::optional<Fault> RtklibParser::parse_epoch(std::string_view& line, Time& time) const {
  const char* const begin = skip_separators(line.data(), line.data() + line.size());
  const char* const end = line.data() + line.size();
  const char* p = begin;
  Duration since_epoch{0};
  auto damage = parse_day_or_week(p, end, since_epoch);
  Time seconds{};
  if (!damage) p = skip_separators(p, end);
  if (!damage) damage = parse_time(p, end, seconds);
  if (!damage && p != end && !is_separator(*p)) damage = LineDamage::kNotANumber;
  since_epoch += seconds.time_since_epoch();
  if (is_utc_) since_epoch += to_utc_ + gps_minus_utc(since_epoch + to_utc_);
  if (damage) {
    constexpr std::size_t kTimeBytes = 24;
    return Fault{*damage, line.substr(static_cast<std::size_t>(begin - line.data()), kTimeBytes)};
  }
  time = Time{since_epoch};
  line.remove_prefix(static_cast<std::size_t>(p - line.data()));
  return std::nullopt;
}

/// What the lines of rtkrcv and of Emlid's .LLH hold, which have no header.
constexpr std::string_view kGeodeticTitles =
    "%  GPST latitude(deg) longitude(deg) height(m) Q ns sdn(m) sde(m) sdu(m) sdne(m) sdeu(m) "
    "sdun(m) age(s) ratio vn(m/s) ve(m/s) vu(m/s) sdvn sdve sdvu sdvne sdveu sdvun";
constexpr std::string_view kEcefTitles =
    "%  GPST x-ecef(m) y-ecef(m) z-ecef(m) Q ns sdx(m) sdy(m) sdz(m) sdxy(m) sdyz(m) sdzx(m) "
    "age(s) ratio vx(m/s) vy(m/s) vz(m/s) sdvx sdvy sdvz sdvxy sdvyz sdvzx";
// Without velocity, with it, and with its covariances; the time is two of them.
constexpr std::array<std::size_t, 3> kHeaderlessFields{15, 21, 24};

double number_of(std::string_view text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

bool is_whole(std::string_view text) {
  return text.find_first_not_of("0123456789") == std::string_view::npos;
}

/// A date or a week, seconds, and then the numbers of a solution, Q and ns among them.
bool is_headerless(std::string_view line) {
  const auto fields = split_fields(line, Separator::kRuns);
  const auto& counts = kHeaderlessFields;
  if (std::find(counts.begin(), counts.end(), fields.size()) == counts.end()) return false;
  const bool is_date = fields[0].size() == 10 && fields[0][4] == '/' && fields[0][7] == '/';
  return (is_date || is_whole(fields[0])) && is_whole(fields[5]) && is_whole(fields[6]);
}

/// The titles of a line without a header. An e/n/u baseline cannot be told from degrees.
std::string titles_of(std::string_view line) {
  const auto fields = split_fields(line, Separator::kRuns);
  const double length =
      std::hypot(number_of(fields[2]), number_of(fields[3]), number_of(fields[4]));
  return std::string(length > 6e6 ? kEcefTitles : kGeodeticTitles);
}

bool is_rtklib(const LogOpening& log) {
  if (log.head.comments.empty()) return is_headerless(log.head.line);
  return !log.head.comments.empty() && log.head.comments.front().starts_with('%');
}

RowParser<GnssFix> rtklib_parser(LogOpening& log) {
  RtklibParser parser;
  for (const std::string& line : log.head.comments) parser.read_header(line, log.lines.path());
  if (!parser.has_columns() && is_headerless(log.head.line)) {
    parser.read_header(titles_of(log.head.line), log.lines.path());
    log.notes.push_back(
        "an RTKLIB solution without its header: times are taken to be GPS time, heights to be "
        "above the ellipsoid");
  }
  if (parser.has_columns()) return parser;
  throw Error(log.lines.path() +
              ": no RTKLIB column header; set the RTKLIB option out-outhead to on");
}

}  // namespace

GnssLayout rtklib_pos() {
  return {"RTKLIB .pos", "RTKLIB .pos with its header", is_rtklib, rtklib_parser};
}

}  // namespace leeway
