/// @file
/// Which error a command allows: metric, limits and presets.
#pragma once

#include "leeway/sim/scene/error_limit.hpp"
#include "sim/cli/answer.hpp"

namespace leeway::cli {

struct LimitChoice {
  std::optional<ErrorMetric> metric{};  ///< absent: the scene's
  std::vector<std::string> limits{};    ///< as sim::allowed_error(); empty: the scene's
  std::string preset{};                 ///< of metric and limit; empty: none
};

/// --metric, --limit and --preset. `--preset list` prints the presets and ends the program.
void add_limit_options(CLI::App& app, LimitChoice& choice);

/// The limits that were asked for one by one. @throws Error when one is none.
std::vector<sim::AllowedError> limits_of(const std::vector<std::string>& texts);

/// Changes a scene's limit as asked: to the first of several.
void change_limit(const LimitChoice& choice, sim::ErrorLimit& limit);

/// A limit as tables have it: "10 m", "5 m + 5 %".
std::string words_of(const sim::AllowedError& allowed);

/// What a metric measures: "horizontal error (drms)".
std::string words_of(ErrorMetric metric);

/// "Limit rnp-1: .." with its source and a line feed; nothing without a preset.
std::string preset_line(const sim::ErrorLimit& limit);

/// limit, limit_m and share.
Json limit_json(const sim::AllowedError& allowed);

/// The same with metric, preset and its source, null without one.
Json limit_json(const sim::ErrorLimit& limit);

}  // namespace leeway::cli
