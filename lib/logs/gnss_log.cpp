#include "leeway/logs/gnss_log.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "lib/logs/csv_header.hpp"
#include "lib/logs/log_columns.hpp"
#include "lib/logs/log_source.hpp"
#include "lib/logs/rtklib_pos.hpp"

namespace leeway {
namespace {

constexpr std::size_t kKfGinsPositionFields = 7;
constexpr std::size_t kKfGinsFixFields = 13;
constexpr std::size_t kSlots = 12;

constexpr std::array kPositionColumns{NamedColumn{"t_s", kTimeColumn},
                                      NamedColumn{"lat_deg", {0, -90.0, 90.0}},
                                      NamedColumn{"lon_deg", {1, -360.0, 360.0}},
                                      NamedColumn{"height_m", {2, -kMaxHeightM, kMaxHeightM}},
                                      NamedColumn{"pos_std_n_m", sigma_column(3)},
                                      NamedColumn{"pos_std_e_m", sigma_column(4)},
                                      NamedColumn{"pos_std_d_m", sigma_column(5)}};
constexpr std::array kVelocityColumns{NamedColumn{"vn_mps", velocity_column(6)},
                                      NamedColumn{"ve_mps", velocity_column(7)},
                                      NamedColumn{"vd_mps", velocity_column(8)},
                                      NamedColumn{"vel_std_n_mps", sigma_column(9, true)},
                                      NamedColumn{"vel_std_e_mps", sigma_column(10, true)},
                                      NamedColumn{"vel_std_d_mps", sigma_column(11, true)}};

std::string gnss_layouts() {
  return "a CSV header with " + join(kPositionColumns) + " (and " + join(kVelocityColumns) +
         "), KF-GINS text (7 or 13 numbers separated by blanks), or RTKLIB .pos with its header";
}

// CSV and KF-GINS text: the same numbers under other separators.
struct NedParser {
  LineParser fields{};
  bool counts_weeks{false};
  WeekUnroller week{};

  std::optional<Fault> operator()(std::string_view line, GnssFix& fix) {
    std::array<double, kSlots> values{};
    std::fill(values.begin() + 6, values.end(), std::numeric_limits<double>::quiet_NaN());
    if (auto fault = fields.parse(line, fix.time, values)) return fault;
    if (counts_weeks) fix.time = week.unroll(fix.time);
    const auto vector_at = [&](std::size_t slot) -> Eigen::Vector3d {
      return Eigen::Map<const Eigen::Vector3d>(values.data() + slot);
    };
    const Geodetic place{values[0] * kRadPerDeg, values[1] * kRadPerDeg, values[2]};
    fix.position =
        GnssPosition::from_geodetic(place, vector_at(3).cwiseAbs2().asDiagonal().toDenseMatrix());
    fix.velocity.reset();
    if (vector_at(6).allFinite() && vector_at(9).allFinite()) {
      fix.velocity = GnssVelocity::from_ned(place, vector_at(6),
                                            vector_at(9).cwiseAbs2().asDiagonal().toDenseMatrix());
    }
    return std::nullopt;
  }
};

struct GnssRowParser {
  GnssLogFormat format{};
  GnssLogOptions options{};
  std::variant<NedParser, RtklibParser> layout{};

  std::optional<Fault> operator()(std::string_view line, GnssFix& fix) {
    if (auto fault = std::visit([&](auto& parse) { return parse(line, fix); }, layout))
      return fault;
    const auto squared = [](double x) { return x * x; };
    fix.time += options.time_offset;
    fix.position->R_e_m2 *= squared(options.position_sigma_scale);
    if (fix.velocity) fix.velocity->R_e_m2ps2 *= squared(options.velocity_sigma_scale);
    if (is_usable(fix)) return std::nullopt;
    return Fault{LineDamage::kOutOfRange, line};
  }
};

NedParser gnss_csv_parser(std::string_view line, const std::string& path) {
  CsvHeader header(line, path);
  if (const auto missing = header.missing(kPositionColumns); !missing.empty()) {
    throw Error(path + ": missing columns " + join(missing) + "; expected " + gnss_layouts());
  }
  header.use(kPositionColumns);
  header.use_group(kVelocityColumns);
  return {header.parser()};
}

NedParser kf_gins_parser(std::size_t field_count, const std::string& path) {
  if (field_count != kKfGinsPositionFields && field_count != kKfGinsFixFields) {
    throw Error(path + ": " + std::to_string(field_count) +
                " fields in a line without a header; expected " + gnss_layouts());
  }
  std::vector<Column> columns;
  for (const NamedColumn& named : kPositionColumns) columns.push_back(named.column);
  if (field_count == kKfGinsFixFields) {
    for (const NamedColumn& named : kVelocityColumns) columns.push_back(named.column);
  }
  return {{Separator::kRuns, std::move(columns)}, true};
}

RtklibParser rtklib_parser(LineReader& lines) {
  RtklibParser parser;
  while (const auto line = lines.next()) {
    if (!line->starts_with('%')) {
      lines.unread();
      break;
    }
    parser.read_header(*line, lines.path());
  }
  if (!parser.has_columns()) {
    throw Error(lines.path() +
                ": no RTKLIB column header; set the RTKLIB option out-outhead to on");
  }
  return parser;
}

bool starts_with_comment_of_rtklib(LineReader& lines) {
  const auto line = lines.next();
  if (line) lines.unread();
  return line && line->starts_with('%');
}

GnssRowParser parser_for(LineReader& lines, const GnssLogOptions& options) {
  if (starts_with_comment_of_rtklib(lines)) {
    return {GnssLogFormat::kRtklib, options, rtklib_parser(lines)};
  }
  const std::string_view line = first_line(lines, gnss_layouts());
  const auto fields = split_fields(line, Separator::kRuns);
  if (is_number(fields.front()) && line.find(',') == std::string_view::npos) {
    return {GnssLogFormat::kKfGins, options, kf_gins_parser(fields.size(), lines.path())};
  }
  GnssRowParser parser{GnssLogFormat::kCsv, options, gnss_csv_parser(line, lines.path())};
  lines.next();  // the header
  return parser;
}

void validate_scale(const char* field, double scale) {
  if (scale > 0.0 && std::isfinite(scale)) return;
  throw Error(std::string("GnssLogOptions::") + field + " of " + std::to_string(scale) +
              ": must be finite and > 0");
}

}  // namespace

struct GnssLogReader::Impl {
  GnssLogFormat format;
  LogSource<GnssFix, GnssRowParser> source;
};

GnssLogReader::GnssLogReader(const std::filesystem::path& path, const GnssLogOptions& options) {
  validate_scale("position_sigma_scale", options.position_sigma_scale);
  validate_scale("velocity_sigma_scale", options.velocity_sigma_scale);
  LineReader lines(path);
  GnssRowParser parser = parser_for(lines, options);
  const GnssLogFormat format = parser.format;
  impl_ = std::make_unique<Impl>(
      Impl{format, LogSource<GnssFix, GnssRowParser>(std::move(lines), std::move(parser))});
}

GnssLogReader::~GnssLogReader() = default;
GnssLogReader::GnssLogReader(GnssLogReader&&) noexcept = default;
GnssLogReader& GnssLogReader::operator=(GnssLogReader&&) noexcept = default;

std::optional<GnssFix> GnssLogReader::next() {
  std::optional<GnssFix> fix = impl_->source.next();
  if (fix) ++impl_->source.report().records;
  return fix;
}

GnssLogFormat GnssLogReader::format() const { return impl_->format; }
const LogSummary& GnssLogReader::report() const { return impl_->source.report(); }

GnssLogWriter::GnssLogWriter(const std::filesystem::path& path)
    : csv_(path,
           {"t_s", "lat_deg", "lon_deg", "height_m", "vn_mps", "ve_mps", "vd_mps", "pos_std_n_m",
            "pos_std_e_m", "pos_std_d_m", "vel_std_n_mps", "vel_std_e_mps", "vel_std_d_mps"}) {}

void GnssLogWriter::write(const GnssFix& fix) {
  if (!fix.position) throw Error("GnssLogWriter: the layout needs a position in every fix");
  const Geodetic place = geodetic_from_ecef(fix.position->r_e_m);
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  const auto sigma_n = [&](const Eigen::Matrix3d& R_e) -> Eigen::Vector3d {
    return (C_en.transpose() * R_e * C_en).diagonal().cwiseSqrt();
  };
  const Eigen::Vector3d p = sigma_n(fix.position->R_e_m2);
  Eigen::Vector3d v = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Eigen::Vector3d s = v;
  if (fix.velocity) {
    v = C_en.transpose() * fix.velocity->v_e_mps;
    s = sigma_n(fix.velocity->R_e_m2ps2);
  }
  csv_.write(fix.time,
             std::array{place.lat_rad / kRadPerDeg, place.lon_rad / kRadPerDeg, place.height_m,
                        v.x(), v.y(), v.z(), p.x(), p.y(), p.z(), s.x(), s.y(), s.z()});
}

}  // namespace leeway
