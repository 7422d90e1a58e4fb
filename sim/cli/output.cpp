#include "output.hpp"

#include <spdlog/fmt/fmt.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <system_error>

#include "commands.hpp"

namespace leeway::cli {

std::string number(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

Table::Table(const std::vector<std::string>& headings) {
  std::vector<std::string> row;
  for (const std::string& heading : headings) {
    is_left_.push_back(heading.starts_with('<'));
    row.push_back(heading.substr(is_left_.back() ? 1 : 0));
  }
  rows_.push_back(std::move(row));
}

void Table::print() const {
  std::vector<std::size_t> widths(is_left_.size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      line += is_left_[c] ? fmt::format("  {:<{}}", row[c], widths[c])
                          : fmt::format("  {:>{}}", row[c], widths[c]);
    }
    fmt::print("{}\n", line.substr(0, line.find_last_not_of(' ') + 1));
  }
}

Json answer_json(std::string_view command, Json input, Json results) {
  return {{"leeway", LEEWAY_VERSION},
          {"command", command},
          {"input", std::move(input)},
          {"results", std::move(results)}};
}

std::string text_of(const Json& json, int indent) {
  // Paths need not be UTF-8.
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

void print_json(const Json& answer) { fmt::print("{}\n", text_of(answer, 2)); }

void print_json(std::string_view command, Json input, Json results) {
  print_json(answer_json(command, std::move(input), std::move(results)));
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  std::filesystem::path partial = path;
  partial += ".partial";
  std::ofstream file(partial, std::ios::binary);
  file << content;
  file.close();
  std::error_code error;
  if (file) std::filesystem::rename(partial, path, error);
  if (file && !error) return;
  std::filesystem::remove(partial, error);
  throw WriteFailure(path.string() + ": cannot be written");
}

Progress::Progress(std::string label)
    : label_(std::move(label)), is_terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::show(double fraction, std::optional<double> remaining_s) {
  constexpr int kWidth = 40;
  constexpr auto kInterval = std::chrono::milliseconds{100};
  const auto now = Clock::now();
  if (!is_terminal_ || now < next_) return;
  next_ = now + kInterval;
  drawn_ = true;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const std::string bar(static_cast<std::size_t>(std::lround(done * kWidth)), '=');
  fmt::print(stderr, "\r{} [{:<{}}] {:3.0f} %", label_, bar, kWidth, 100.0 * done);
  if (!remaining_s) return;
  const auto seconds = std::llround(std::clamp(*remaining_s, 0.0, 1e9));
  fmt::print(stderr, ", {}:{:02}:{:02} to go \033[K", seconds / 3600, seconds / 60 % 60,
             seconds % 60);
}

}  // namespace leeway::cli
