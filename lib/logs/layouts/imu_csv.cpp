#include "lib/logs/csv_header.hpp"
#include "lib/logs/layouts/imu_layouts.hpp"

namespace leeway {
namespace {

constexpr std::array kRates{
    NamedColumn{"t_s", kTimeColumn},     NamedColumn{"gx_radps", angular(0)},
    NamedColumn{"gy_radps", angular(1)}, NamedColumn{"gz_radps", angular(2)},
    NamedColumn{"ax_mps2", linear(0)},   NamedColumn{"ay_mps2", linear(1)},
    NamedColumn{"az_mps2", linear(2)}};
constexpr std::array kIncrements{
    NamedColumn{"t_s", kTimeColumn},         NamedColumn{"dt_s", kImuStep},
    NamedColumn{"dtheta_x_rad", angular(0)}, NamedColumn{"dtheta_y_rad", angular(1)},
    NamedColumn{"dtheta_z_rad", angular(2)}, NamedColumn{"dv_x_mps", linear(0)},
    NamedColumn{"dv_y_mps", linear(1)},      NamedColumn{"dv_z_mps", linear(2)}};

RowParser<ImuRow> rates_parser(LogOpening& log) {
  // Of a header that has neither, the error is what it lacks of the nearer one.
  const CsvHeader seen = CsvHeader::understood(log.head.line, log.lines.path(), log.format);
  const bool is_rates = seen.missing(kRates).size() <= seen.missing(kIncrements).size();
  const std::span<const NamedColumn> increments = kIncrements;
  const CsvHeader header =
      take_csv_header(log, is_rates ? kRates : increments, list_of(imu_layouts()), kSlowestImuS);
  header.note(log.notes);
  return ImuFields{header.parser(), true, WeekUnroller{}};
}

RowParser<ImuRow> increments_parser(LogOpening& log) {
  const CsvHeader header = take_csv_header(log, kIncrements, list_of(imu_layouts()), kSlowestImuS);
  header.note(log.notes);
  return ImuFields{header.parser(), false, WeekUnroller{}};
}

}  // namespace

ImuLayout imu_csv_rates() {
  return {"CSV, rates", "a CSV header with " + join(kRates) + " (rates)",
          [](const LogOpening&) { return true; }, rates_parser};
}

ImuLayout imu_csv_increments() {
  return {"CSV, increments", "one with " + join(kIncrements) + " (increments)",
          [](const LogOpening& log) {
            return CsvHeader::understood(log.head.line, "", log.format).has(kIncrements);
          },
          increments_parser};
}

}  // namespace leeway
