/// @file
/// The sections of a scene file. Each reader declares the keys of its section, with their units and
/// ranges; what is absent keeps the default of the struct it fills.
#pragma once

#include "leeway/sim/scene/scene.hpp"
#include "sim/tools/toml_reader.hpp"

namespace leeway::sim {

inline constexpr double kShortestSceneS = 1.0;
inline constexpr double kLongestSceneS = 1e6;

/// @throws Error unless the path is a file of a length that scenes and models have.
void require_text_file(const std::filesystem::path& path);

/// [trajectory]. @param duration_s  absent: that of a route or a recording, one hour of the others
Trajectory read_trajectory(TomlSection& section, const std::filesystem::path& folder,
                           std::optional<double> duration_s);

struct NamedImuModel {
  std::string name{};
  ImuErrorModel model{};
};

/// [imu] or [filter.imu].
NamedImuModel read_imu(TomlSection& section, const std::filesystem::path& folder);

/// [gnss]. Outages must be within the duration, or are left out beyond it.
GnssScenario read_gnss(TomlSection& section, double duration_s, bool leave_out_late_outages);

/// [vehicle].
SceneVehicle read_vehicle(TomlSection& section);

/// [filter], but for its IMU: how the scene's filter runs.
void read_filter(TomlSection& section, Scene& scene);

/// [initial]: every key is required.
InitialSigma read_initial(TomlSection& section);

/// [limit].
ErrorLimit read_limit(TomlSection& section);

}  // namespace leeway::sim
