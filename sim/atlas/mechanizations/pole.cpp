#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "leeway/earth/rotation.hpp"
#include "sim/atlas/crossing.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kFromPoleRad = 0.3 * kRadPerDeg;
constexpr double kFromPoleM = kFromPoleRad * 6.4e6;

/// From one side of the north pole to the other, past it at this distance.
Scene past_pole(double distance_m) {
  const double lat_rad = 90.0 * kRadPerDeg - kFromPoleRad;
  const double lon_rad = 10.0 * kRadPerDeg;
  const double half_turn_rad = 180.0 * kRadPerDeg - 2.0 * std::asin(distance_m / kFromPoleM);
  return crossing({lat_rad, lon_rad, 11e3}, {lat_rad, wrap_pi(lon_rad + half_turn_rad), 11e3});
}

std::vector<AtlasCell> run_pole(const AtlasOptions& options) {
  return cells_over(std::vector{0.0, 10.0, 1e3, 10e3}, [&](double distance_m) {
    const Scene scene = past_pole(distance_m);
    const std::string condition = fmt::format("past it at {:g} m", distance_m);
    std::vector<AtlasCell> cells = crossed_without_fixes(scene, condition);
    if (distance_m > 0.0) return cells;
    append(cells, crossed_with_fixes(scene, condition, options.brief ? 1 : 4));
    return cells;
  });
}

}  // namespace

AtlasScene pole() {
  return {.place = 220,
          .key = "pole",
          .title = "Over the north pole",
          .figure = "error of the position",
          .unit = "m",
          .limits = crossing_limits(),
          .run = run_pole};
}

}  // namespace leeway::sim::scenes
