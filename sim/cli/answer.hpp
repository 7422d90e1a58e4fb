/// @file
/// What a command found, in the three forms in which it is shown: tables, a JSON object, a page.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <functional>
#include <string_view>

#include "sim/cli/json.hpp"

namespace leeway::cli {

/// In which forms a command shows its answer.
struct Output {
  std::filesystem::path report{};  ///< the page; empty: none
  bool json{false};                ///< in place of the tables
};

/// --json and --report. A page is refused, before anything is computed, where the program was built
/// without one.
void add_output_options(CLI::App& app, Output& output);
void add_json_option(CLI::App& app, bool& json);

/// What a command found, for programs: the contract of --json.
Json answer_json(std::string_view command, Json input, Json results);

/// Shows an answer_json(): as it is or by its tables on stdout, and as a page.
/// @param series  what the page alone shows: SeriesTable::json() by name
/// @throws WriteFailure when the page cannot be written
void show(
    const Output& output, const Json& answer, const std::function<void()>& print_tables,
    const std::function<Json()>& series = [] { return Json::object(); });

}  // namespace leeway::cli
