/// @file
/// The roofline of a scene for the page of `leeway interval`.
#pragma once

#include <map>

#include "leeway/sim/scene/scene.hpp"
#include "sim/cli/pages/series_table.hpp"

namespace leeway::cli {

/// Columns interval_s, a line each (`fix_position_m`, ..), roof_m, sum_m, and true_m of the
/// analysis, which is missing where none was made. From 0.1 s to longest_interval_s(), ascending.
/// @param true_m  by interval, s
/// @throws Error when the scene is invalid.
SeriesTable roofline_series(const sim::Scene& scene, const std::map<double, double>& true_m);

}  // namespace leeway::cli
