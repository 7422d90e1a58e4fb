#include <vector>

#include "leeway/earth/error.hpp"
#include "lib/logs/layouts/gnss_layouts.hpp"

namespace leeway {
namespace {

constexpr std::size_t kPositionFields = kPositionColumns.size();
constexpr std::size_t kFixFields = kPositionFields + kVelocityColumns.size();

RowParser<GnssFix> kf_gins_fix_parser(const LogHead& head, LineReader& lines) {
  const std::size_t fields = split_fields(head.line, Separator::kRuns).size();
  if (fields != kPositionFields && fields != kFixFields) {
    throw Error(lines.path() + ": " + std::to_string(fields) +
                " fields in a line without a header; expected " + list_of(gnss_layouts()));
  }
  std::vector<Column> columns;
  for (const NamedColumn& named : kPositionColumns) columns.push_back(named.column);
  if (fields == kFixFields) {
    for (const NamedColumn& named : kVelocityColumns) columns.push_back(named.column);
  }
  return GnssFields{{Separator::kRuns, std::move(columns)}, WeekUnroller{}};
}

}  // namespace

GnssLayout gnss_kf_gins() {
  return {"KF-GINS text", "KF-GINS text (7 or 13 numbers separated by blanks)",
          [](const LogHead& head) { return is_bare_numbers(head.line); }, kf_gins_fix_parser};
}

}  // namespace leeway
