/// @file
/// What the commands write: tables, whole files, notes, a progress bar.
#pragma once

#include <spdlog/fmt/fmt.h>

#include <chrono>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/earth/error.hpp"

namespace leeway::cli {

/// A number with so many decimals, or "-" for what is not defined.
std::string number(double value, int decimals);

/// Seconds with three significant digits, or "-".
std::string seconds(double s);

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

/// A result could not be written.
struct WriteFailure : Error {
  using Error::Error;
};

/// Runs what writes results. @throws WriteFailure in place of Error.
template <class F>
auto writing(F&& write) {
  try {
    return write();
  } catch (const Error& error) {
    throw WriteFailure(error.what());
  }
}

/// Writes a file as a whole or not at all. @throws WriteFailure
void write_file(const std::filesystem::path& path, std::string_view content);

/// A line on stderr, once however often it is said and however many ranks run.
void note(std::string_view text);

/// A bar on stderr, where that is a terminal, once the work has taken a second, with the time to
/// go. Gone afterwards. Of several ranks, the first shows it.
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
  void operator()(double fraction) { show(fraction); }

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  bool is_terminal_;
  Clock::time_point begin_{Clock::now()};
  Clock::time_point next_{begin_ + std::chrono::seconds{1}};
  bool drawn_{false};
};

}  // namespace leeway::cli
