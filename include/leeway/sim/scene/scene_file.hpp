/// @file
/// Scenes as TOML files: docs/guide/scenes.md has the sections, keys, units, ranges and defaults.
#pragma once

#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

inline constexpr std::size_t kLongestSceneFile = 1 << 20;  ///< bytes

/// A scene from a file, valid as validate(Scene) means it. Files that it names are taken relative
/// to its folder.
/// @param duration_s  in place of the file's: trajectories that have no end go on to it, and
/// outages beyond it are left out
/// @param notes  unless null, gets a line for each old name that the file uses
/// @throws Error with path:line:column and what to write instead, when the file is unreadable, is
/// no TOML, has an unknown or missing key, a value out of its plausible range (naming the unit in
/// which it would be plausible), or contradicts itself; also when the trajectory ends before
/// duration_s.
Scene read_scene(const std::filesystem::path& path, std::optional<double> duration_s = {},
                 std::vector<std::string>* notes = nullptr);

/// The same from text.
/// @param name  what messages call it; files are taken relative to its folder
Scene parse_scene(std::string_view text, const std::string& name,
                  std::optional<double> duration_s = {}, std::vector<std::string>* notes = nullptr);

}  // namespace leeway::sim
