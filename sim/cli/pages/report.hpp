/// @file
/// Reports: one HTML file that shows a command's answer in words and charts, and needs nothing
/// else.
#pragma once

#include <filesystem>
#include <vector>

#include "sim/cli/json.hpp"

namespace leeway::cli {

/// Why the program can write none, and what to do; empty when it can.
std::string why_no_report();

/// What a report names as its origin: the words after the program's name. Call once, first.
void remember_command_line(const std::vector<std::string>& words);

/// Writes the page around an answer_json().
/// @param series  tables by name, each a SeriesTable::json()
/// @throws WriteFailure
void write_report(const std::filesystem::path& path, Json answer, Json series);

}  // namespace leeway::cli
