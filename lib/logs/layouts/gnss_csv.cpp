#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "leeway/earth/rotation.hpp"
#include "lib/logs/layouts/gnss_layouts.hpp"

namespace leeway {
namespace {

RowParser<GnssFix> fix_csv_parser(LogOpening& log) {
  const std::size_t told = log.format.gnss_sigma.size();
  const std::span<const NamedColumn> position = kPositionColumns, velocity = kVelocityColumns;
  CsvHeader header =
      take_csv_header(log, told > 0 ? position.first<4>() : position, list_of(gnss_layouts()));
  header.use_group(told == 4 ? velocity.first<3>() : velocity);
  if (header.has(kHeadingColumns)) header.use(kHeadingColumns);
  header.note(log.notes);
  return GnssFields{header.parser(), WeekUnroller{}, told};
}

/// Nothing where a receiver has none, which it may say by a sigma of zero.
std::optional<GnssHeading> heading_of(double heading_deg, double sigma_deg) {
  if (std::isnan(heading_deg) || sigma_deg == 0.0) return std::nullopt;
  GnssHeading heading{heading_deg * kRadPerDeg};
  if (!std::isnan(sigma_deg)) heading.sigma_rad = sigma_deg * kRadPerDeg;
  return heading;
}

}  // namespace

std::optional<Fault> GnssFields::operator()(std::string_view line, GnssFix& fix) {
  std::array<double, kSlots> values{};
  std::fill(values.begin() + 6, values.end(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = 0; k < told_sigmas / 2; ++k) {
    std::fill_n(values.begin() + 3 + 6 * static_cast<std::ptrdiff_t>(k), 3, 1.0);
  }
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
  fix.heading = heading_of(values[12], values[13]);
  return std::nullopt;
}

GnssLayout gnss_csv() {
  return {"CSV",
          "a CSV header with " + join(kPositionColumns) + " (and " + join(kVelocityColumns) + "; " +
              join(kHeadingColumns) + ")",
          [](const LogOpening&) { return true; }, fix_csv_parser};
}

}  // namespace leeway
