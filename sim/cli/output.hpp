/// @file
/// What the commands write: tables, the one JSON object, whole files, a progress bar.
#pragma once

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace leeway::cli {

/// Keys stay in the order they are added.
using Json = nlohmann::ordered_json;

/// A number with so many decimals, or "-" for what is not defined.
std::string number(double value, int decimals);

/// What a row of a table says: its colour on a terminal that shows any, unless NO_COLOR is set.
enum class Tone { kPlain, kGood, kDoubtful, kBad };

/// Aligned columns: to the right, or to the left where the heading begins with '<'.
class Table {
 public:
  explicit Table(const std::vector<std::string>& headings);
  void add(std::vector<std::string> row, Tone tone = Tone::kPlain) {
    rows_.push_back({std::move(row), tone});
  }

  /// On stdout, indented by two.
  void print() const;

 private:
  struct Row {
    std::vector<std::string> cells{};
    Tone tone{Tone::kPlain};
  };

  std::vector<bool> is_left_{};
  std::vector<std::string> headings_{};
  std::vector<Row> rows_{};
};

/// What a command found, for programs: the contract of --json.
Json answer_json(std::string_view command, Json input, Json results);

/// Numbers that are not finite become null; what is not UTF-8 is replaced.
std::string text_of(const Json& json, int indent = -1);

/// Exactly this object on stdout.
void print_json(const Json& answer);
void print_json(std::string_view command, Json input, Json results);

/// Writes a file as a whole or not at all. @throws WriteFailure
void write_file(const std::filesystem::path& path, std::string_view content);

/// A bar on stderr, where that is a terminal, once the work has taken a second, with the time to
/// go. Gone afterwards.
class Progress {
 public:
  explicit Progress(std::string label);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Whether anybody can see it.
  bool visible() const { return is_terminal_; }
  /// @param remaining_s  the time to go; absent: as long as what is done took
  void show(double fraction, std::optional<double> remaining_s = {});

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  bool is_terminal_;
  Clock::time_point begin_{Clock::now()};
  Clock::time_point next_{begin_ + std::chrono::seconds{1}};
  bool drawn_{false};
};

}  // namespace leeway::cli
