#include "leeway/earth/rotation.hpp"
#include "sim/atlas/crossing.hpp"

namespace leeway::sim::scenes {
namespace {

/// South of Fiji, eastwards.
Scene past_180_deg() {
  const double lat_rad = -20.0 * kRadPerDeg;
  return crossing({lat_rad, 179.9 * kRadPerDeg, 11e3}, {lat_rad, -179.8 * kRadPerDeg, 11e3});
}

std::vector<AtlasCell> run_antimeridian(const AtlasOptions& options) {
  const Scene scene = past_180_deg();
  std::vector<AtlasCell> cells = crossed_without_fixes(scene, {});
  cells.push_back(crossed_in_latitude_and_longitude(scene, {}, 0.1));
  append(cells, crossed_with_fixes(scene, {}, options.brief ? 1 : 4));
  return cells;
}

}  // namespace

AtlasScene antimeridian() {
  return {.place = 230,
          .key = "antimeridian",
          .title = "Across the antimeridian",
          .figure = "error of the position",
          .unit = "m",
          .limits = crossing_limits(),
          .run = run_antimeridian};
}

}  // namespace leeway::sim::scenes
