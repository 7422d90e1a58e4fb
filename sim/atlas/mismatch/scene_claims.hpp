/// @file
/// The navigator in a scene that has few fixes after many, against the linear analysis of the same.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "leeway/navigator/vehicle_kind.hpp"
#include "leeway/sim/scene/scene.hpp"
#include "sim/atlas/mismatch/claim_run.hpp"

namespace leeway::sim {

/// What a navigator makes of a scene at one interval.
struct SceneClaim {
  VehicleKind vehicle{};
  int fix_interval_s{};
  ClaimSums before_fixes{};  ///< of all trials
  ClaimSums between{};
  std::vector<std::uint64_t> lost{};  ///< seeds
  double r95_m{};                     ///< what 95 % of the horizontal errors before fixes are below
  /// What 95 % of these errors are below, each over the R95 of the linear analysis at its fix.
  double r95_over_linear{};
};

/// The default navigator, told the lever arm alone, as VehicleKind::kNone and kCar, on the first
/// kDenseS + kSparseS of the scene, outliers and latency included. A fix every second, then every
/// T: 1, 5, 10, 20 s. Seeds 1 to trials. The same bits on any number of threads.
/// @throws Error when the scene is invalid or shorter.
std::vector<SceneClaim> run_scene_claims(const Scene& scene, int trials, int threads = 0,
                                         const std::function<void(double fraction)>& progress = {});

}  // namespace leeway::sim
