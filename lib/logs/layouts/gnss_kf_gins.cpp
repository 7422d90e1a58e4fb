#include <vector>

#include "leeway/earth/error.hpp"
#include "lib/logs/layouts/gnss_layouts.hpp"

namespace leeway {
namespace {

constexpr std::size_t kPositionFields = kPositionColumns.size();
constexpr std::size_t kWithoutSigmas = kPositionFields + 3;  // of velocity
constexpr std::size_t kFixFields = kPositionFields + kVelocityColumns.size();

RowParser<GnssFix> kf_gins_fix_parser(LogOpening& log) {
  const std::size_t fields = split_fields(log.head.line, Separator::kRuns).size();
  if (fields != kPositionFields && fields != kWithoutSigmas && fields != kFixFields) {
    throw Error(log.lines.path() + ": " + std::to_string(fields) +
                " fields in a line without a header; expected " + list_of(gnss_layouts()));
  }
  std::vector<Column> columns;
  for (const NamedColumn& named : kPositionColumns) columns.push_back(named.column);
  const std::size_t told = log.format.gnss_sigma.size();
  if (fields == kWithoutSigmas && told < 4) {
    log.notes.push_back(
        "velocity without standard deviations is not used: say --gnss-sigma H,V,VH,VV");
  }
  if (fields > kPositionFields) {
    for (const NamedColumn& named : kVelocityColumns) columns.push_back(named.column);
  }
  return GnssFields{{Separator::kRuns, std::move(columns)}, WeekUnroller{}, told};
}

}  // namespace

GnssLayout gnss_kf_gins() {
  return {"KF-GINS text", "KF-GINS text (7, 10 or 13 numbers separated by blanks)",
          [](const LogOpening& log) { return is_bare_numbers(log.head.line); }, kf_gins_fix_parser};
}

}  // namespace leeway
