/// @file
/// How a filter runs, as a TOML file of its own: a [filter] section with the keys that it has in a
/// scene file. docs/guide/scenes.md lists them.
#pragma once

#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// A change of what the file states in how the scene's filter runs; the rest stays as it is.
/// @throws Error with file, line and column when the file cannot be read or is not such a file.
void read_filter_file(const std::filesystem::path& path, Scene& scene);

/// Text of the file that has another scene's filter run as this one's. What the filter is told of
/// the sensors and the receiver is left to that scene.
/// @param comment  lines put on top, without their "#"
std::string filter_file(const Scene& scene, std::string_view comment);

}  // namespace leeway::sim
