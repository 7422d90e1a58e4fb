#include "lib/logs/layouts/imu_layouts.hpp"

namespace leeway {
namespace {

constexpr std::array kKfGinsColumns{kTimeColumn, angular(0), angular(1), angular(2),
                                    linear(0),   linear(1),  linear(2)};

bool is_kf_gins_imu(const LogOpening& log) {
  return is_bare_numbers(log.head.line) &&
         split_fields(log.head.line, Separator::kRuns).size() >= kKfGinsColumns.size();
}

RowParser<ImuRow> kf_gins_imu_parser(LogOpening&) {
  return ImuFields{.fields = {Separator::kRuns, {kKfGinsColumns.begin(), kKfGinsColumns.end()}},
                   .week = WeekUnroller{}};
}

}  // namespace

ImuLayout imu_kf_gins() {
  return {"KF-GINS text", "KF-GINS text: seconds of week and 6 increments, separated by blanks",
          is_kf_gins_imu, kf_gins_imu_parser};
}

}  // namespace leeway
