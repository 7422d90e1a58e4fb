/// @file
/// How the errors of trials spread over time, for a report.
#pragma once

#include "leeway/sim/scene/scene.hpp"
#include "sim/cli/json.hpp"

namespace leeway::cli {

/// Runs the scene's trials, the first 100 of them, and keeps the percentiles of the horizontal
/// error before each fix: a table fan (t_s, p2_5_m, p25_m, p50_m, p75_m, p95_m, p97_5_m,
/// claimed_r95_m), the last the median of what the trials claim.
/// @param threads  0: all processors
/// @throws Error when the scene is invalid.
Json campaign_fan(const sim::Scene& scene, int threads);

}  // namespace leeway::cli
