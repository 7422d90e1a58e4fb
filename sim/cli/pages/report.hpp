/// @file
/// Reports: one HTML file that shows a command's answer in words and charts, and needs nothing
/// else.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "sim/cli/output.hpp"

namespace leeway::cli {

/// --report FILE. Refused, before anything is computed, where the program was built without its
/// page.
void add_report_option(CLI::App& app, std::filesystem::path& path);

/// What a report names as its origin. Call once, first.
void remember_command_line(int argc, const char* const* argv);

/// Writes the page around an answer_json(). Nothing when the path is empty.
/// @param series  tables by name, each a ReportTable::json()
/// @throws WriteFailure
void write_report(const std::filesystem::path& path, Json answer, Json series = Json::object());

}  // namespace leeway::cli
