/// @file
/// The inverse question of `leeway interval --need`: which IMU keeps the limit at this interval.
#pragma once

#include <CLI/App.hpp>
#include <optional>

#include "sim/cli/scene_options.hpp"

namespace leeway::cli {

/// --need. @returns the option, for what excludes it
CLI::Option* add_need_option(CLI::App& app, std::optional<double>& need_s);

/// Answers it for every IMU and limit that the command line names, else for the scene's own.
/// @returns the exit code
/// @throws Error when the scene does not hold two such intervals, or is invalid.
int answer_need(const SceneChoice& choice, double need_s, const Output& output);

}  // namespace leeway::cli
