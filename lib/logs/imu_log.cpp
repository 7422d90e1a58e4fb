#include "leeway/logs/imu_log.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "leeway/earth/error.hpp"
#include "lib/logs/csv_header.hpp"
#include "lib/logs/log_columns.hpp"
#include "lib/logs/log_source.hpp"

namespace leeway {
namespace {

constexpr double kMaxAngular = 1e3;
constexpr double kMaxLinear = 1e5;
constexpr double kMaxStepS = 3600.0;
constexpr double kRotationTolerance = 1e-6;
constexpr std::size_t kKfGinsImuFields = 7;

constexpr Column kStep{6, kSmallest, kMaxStepS};
constexpr Column angular(int axis) { return {axis, -kMaxAngular, kMaxAngular}; }
constexpr Column linear(int axis) { return {3 + axis, -kMaxLinear, kMaxLinear}; }

constexpr std::array kRates{
    NamedColumn{"t_s", kTimeColumn},     NamedColumn{"gx_radps", angular(0)},
    NamedColumn{"gy_radps", angular(1)}, NamedColumn{"gz_radps", angular(2)},
    NamedColumn{"ax_mps2", linear(0)},   NamedColumn{"ay_mps2", linear(1)},
    NamedColumn{"az_mps2", linear(2)}};
constexpr std::array kIncrements{
    NamedColumn{"t_s", kTimeColumn},         NamedColumn{"dt_s", kStep},
    NamedColumn{"dtheta_x_rad", angular(0)}, NamedColumn{"dtheta_y_rad", angular(1)},
    NamedColumn{"dtheta_z_rad", angular(2)}, NamedColumn{"dv_x_mps", linear(0)},
    NamedColumn{"dv_y_mps", linear(1)},      NamedColumn{"dv_z_mps", linear(2)}};

// One line, whatever the layout: rates or increments, dt_s only where the line has it.
struct ImuRow {
  Time time{};
  Eigen::Vector3d angular{Eigen::Vector3d::Zero()};
  Eigen::Vector3d linear{Eigen::Vector3d::Zero()};
  double dt_s{};
};

struct ImuRowParser {
  ImuLogFormat format{};
  LineParser fields{};
  WeekUnroller week{};

  std::optional<Fault> operator()(std::string_view line, ImuRow& row) {
    std::array<double, 7> values{};
    if (auto fault = fields.parse(line, row.time, values)) return fault;
    if (format == ImuLogFormat::kKfGins) row.time = week.unroll(row.time);
    row.angular = Eigen::Map<const Eigen::Vector3d>(values.data());
    row.linear = Eigen::Map<const Eigen::Vector3d>(values.data() + 3);
    row.dt_s = values[6];
    return std::nullopt;
  }
};

std::string imu_layouts() {
  return "a CSV header with " + join(kRates) + " (rates) or " + join(kIncrements) +
         " (increments), or KF-GINS text: seconds of week and 6 increments, separated by blanks";
}

ImuRowParser imu_csv_parser(std::string_view line, const std::string& path) {
  CsvHeader header(line, path);
  const bool increments = header.has(kIncrements);
  if (!increments && !header.has(kRates)) {
    const auto no_rates = header.missing(kRates);
    const auto no_increments = header.missing(kIncrements);
    throw Error(path + ": missing columns " +
                join(no_rates.size() <= no_increments.size() ? no_rates : no_increments) +
                "; expected " + imu_layouts());
  }
  if (increments) {
    header.use(kIncrements);
  } else {
    header.use(kRates);
  }
  return {increments ? ImuLogFormat::kCsvIncrements : ImuLogFormat::kCsvRates, header.parser()};
}

ImuRowParser parser_for(LineReader& lines) {
  const std::string_view line = first_line(lines, imu_layouts());
  const auto fields = split_fields(line, Separator::kRuns);
  const bool has_header = !is_number(fields.front());
  if (!has_header && fields.size() >= kKfGinsImuFields &&
      line.find(',') == std::string_view::npos) {
    return {ImuLogFormat::kKfGins,
            {Separator::kRuns,
             {kTimeColumn, angular(0), angular(1), angular(2), linear(0), linear(1), linear(2)}}};
  }
  ImuRowParser parser = imu_csv_parser(line, lines.path());
  lines.next();  // the header
  return parser;
}

bool is_proper_rotation(const Eigen::Matrix3d& C) {
  return (C * C.transpose()).isIdentity(kRotationTolerance) && C.determinant() > 0.0;
}

}  // namespace

struct ImuLogReader::Impl {
  Impl(LineReader lines, ImuRowParser parser, const ImuLogOptions& chosen)
      : format(parser.format),
        options(chosen),
        rotates(chosen.C_bs != Eigen::Matrix3d::Identity()),
        source(std::move(lines), std::move(parser)) {}

  ImuLogFormat format;
  ImuLogOptions options;
  bool rotates;
  LogSource<ImuRow, ImuRowParser> source;
  std::optional<ImuRow> previous{};

  ImuIncrement increment(const ImuRow& row) const {
    if (format == ImuLogFormat::kCsvIncrements)
      return {row.time, row.dt_s, row.angular, row.linear};
    if (format == ImuLogFormat::kCsvRates) {
      return increment_between({previous->time, previous->angular, previous->linear},
                               {row.time, row.angular, row.linear}, options.meaning);
    }
    return {row.time, to_seconds(row.time - previous->time), row.angular, row.linear};
  }
};

ImuLogReader::ImuLogReader(const std::filesystem::path& path, const ImuLogOptions& options) {
  if (!is_proper_rotation(options.C_bs)) {
    throw Error("ImuLogOptions::C_bs: must be a proper rotation (orthonormal, determinant +1)");
  }
  LineReader lines(path);
  ImuRowParser parser = parser_for(lines);
  impl_ = std::make_unique<Impl>(std::move(lines), std::move(parser), options);
}

ImuLogReader::~ImuLogReader() = default;
ImuLogReader::ImuLogReader(ImuLogReader&&) noexcept = default;
ImuLogReader& ImuLogReader::operator=(ImuLogReader&&) noexcept = default;

std::optional<ImuIncrement> ImuLogReader::next() {
  Impl& log = *impl_;
  const bool needs_previous = log.format != ImuLogFormat::kCsvIncrements;
  if (needs_previous && !log.previous) log.previous = log.source.next();
  const std::optional<ImuRow> row = log.source.next();
  if (!row) return std::nullopt;
  ImuIncrement inc = log.increment(*row);
  if (needs_previous) log.previous = row;
  if (log.rotates) {
    inc.dtheta_b_rad = log.options.C_bs * inc.dtheta_b_rad;
    inc.dv_b_mps = log.options.C_bs * inc.dv_b_mps;
  }
  ++log.source.report().records;
  return inc;
}

ImuLogFormat ImuLogReader::format() const { return impl_->format; }
const LogSummary& ImuLogReader::report() const { return impl_->source.report(); }

ImuLogWriter::ImuLogWriter(const std::filesystem::path& path)
    : csv_(path, {"t_s", "dt_s", "dtheta_x_rad", "dtheta_y_rad", "dtheta_z_rad", "dv_x_mps",
                  "dv_y_mps", "dv_z_mps"}) {}

void ImuLogWriter::write(const ImuIncrement& inc) {
  const Eigen::Vector3d& a = inc.dtheta_b_rad;
  const Eigen::Vector3d& v = inc.dv_b_mps;
  csv_.write(inc.time, std::array{inc.dt_s, a.x(), a.y(), a.z(), v.x(), v.y(), v.z()});
}

}  // namespace leeway
