/// @file
/// A scene turned into logs: what its sensors and its receiver would have recorded, and the truth.
#pragma once

#include <cstdint>
#include <filesystem>

#include "leeway/sim/scene/scene.hpp"
#include "sim/cli/output.hpp"

namespace leeway::cli {

struct SceneLogOptions {
  std::filesystem::path out{};  ///< folder; made when missing
  double truth_rate_hz{20.0};
  std::uint64_t seed{1};
  bool gzip{false};
};

/// What was written.
struct SceneLogs {
  std::filesystem::path imu{};
  std::filesystem::path gnss{};
  std::filesystem::path truth{};
  std::int64_t imu_increments{0};
  std::int64_t gnss_fixes{0};
  std::int64_t truth_rows{0};
};

/// Writes the logs one after the other, in constant memory. Fixes in outages are left out, outliers
/// are in; a fix has the time it is valid at, whatever the latency.
/// @throws Error when a log cannot be written, or the scene is not valid.
SceneLogs write_scene_logs(const sim::Scene& scene, const SceneLogOptions& options,
                           Progress& progress);

}  // namespace leeway::cli
