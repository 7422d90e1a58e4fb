#include <algorithm>
#include <limits>

#include "leeway/earth/rotation.hpp"
#include "lib/logs/layouts/gnss_layouts.hpp"

namespace leeway {
namespace {

RowParser<GnssFix> fix_csv_parser(const LogHead&, LineReader& lines) {
  CsvHeader header = take_csv_header(lines, kPositionColumns, list_of(gnss_layouts()));
  header.use_group(kVelocityColumns);
  return GnssFields{header.parser()};
}

}  // namespace

std::optional<Fault> GnssFields::operator()(std::string_view line, GnssFix& fix) {
  std::array<double, kSlots> values{};
  std::fill(values.begin() + 6, values.end(), std::numeric_limits<double>::quiet_NaN());
  if (auto fault = fields.parse(line, fix.time, values)) return fault;
  if (week) fix.time = week->unroll(fix.time);
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

GnssLayout gnss_csv() {
  return {"CSV",
          "a CSV header with " + join(kPositionColumns) + " (and " + join(kVelocityColumns) + ")",
          [](const LogHead&) { return true; }, fix_csv_parser};
}

}  // namespace leeway
