/// @file
/// What a command found, in the three forms in which it is shown: tables, a JSON object, a page.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <functional>

#include "sim/cli/json.hpp"
#include "sim/cli/output.hpp"

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

/// An option that takes the name of a file.
CLI::Option* add_file_option(CLI::App& app, const std::string& name, std::filesystem::path& file,
                             const std::string& meaning, const char* type = "FILE");

/// An option whose help shows its default.
template <class Value>
CLI::Option* add_default_option(CLI::App& app, const std::string& name, Value& value,
                                const std::string& meaning) {
  return app.add_option(name, value, meaning)->capture_default_str();
}

/// A value of a row: under a heading in tables, under a key in JSON. Where one of them is empty,
/// only in the other.
struct Cell {
  std::string heading{};  ///< as Table has it
  std::string key{};
  Json value{};
  int decimals{0};  ///< of a number in a table; whole numbers have none
};
using Row = std::vector<Cell>;

Json row_json(const Row& row);
Table table_of(const Row& any);
void add_row(Table& table, const Row& row, Tone tone = Tone::kPlain);

/// What a command found, for programs: the contract of --json.
Json answer_json(std::string_view command, Json input, Json results);

/// Shows an answer_json(): as it is or by its tables on stdout, and as a page.
/// @param series  what the page alone shows: SeriesTable::json() by name
/// @throws WriteFailure when the page cannot be written
void show(
    const Output& output, const Json& answer, const std::function<void()>& print_tables,
    const std::function<Json()>& series = [] { return Json::object(); });

}  // namespace leeway::cli
