#include "sim/cli/output.hpp"

#include <fmt/color.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <set>
#include <system_error>

#include "leeway/sim/tools/ranks.hpp"

namespace leeway::cli {
namespace {

/// https://no-color.org
bool shows_colour() {
  const char* no_color = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return isatty(STDOUT_FILENO) != 0 && (no_color == nullptr || *no_color == '\0') &&
         (terminal == nullptr || std::string_view(terminal) != "dumb");
}

fmt::text_style style_of(Tone tone) {
  if (tone == Tone::kPlain) return {};
  using Color = fmt::terminal_color;
  return fmt::fg(tone == Tone::kGood       ? Color::green
                 : tone == Tone::kDoubtful ? Color::yellow
                                           : Color::red);
}

}  // namespace

std::string number(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "-";
}

std::string seconds(double s) { return number(s, s < 10.0 ? 2 : s < 100.0 ? 1 : 0); }

Table::Table(const std::vector<std::string>& headings) {
  for (const std::string& heading : headings) {
    is_left_.push_back(heading.starts_with('<'));
    headings_.push_back(heading.substr(is_left_.back() ? 1 : 0));
  }
}

void Table::print() const {
  std::vector<std::size_t> widths;
  for (std::size_t c = 0; c < headings_.size(); ++c) {
    widths.push_back(headings_[c].size());
    for (const Row& row : rows_) widths[c] = std::max(widths[c], row.cells[c].size());
  }
  const bool in_colour = shows_colour();
  const auto print_line = [&](const std::vector<std::string>& cells, fmt::text_style style) {
    std::string line;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      line += is_left_[c] ? fmt::format("  {:<{}}", cells[c], widths[c])
                          : fmt::format("  {:>{}}", cells[c], widths[c]);
    }
    line.resize(line.find_last_not_of(' ') + 1);
    fmt::print(in_colour ? style : fmt::text_style{}, "{}", line);
    fmt::print("\n");
  };
  print_line(headings_, fmt::emphasis::bold);
  for (const Row& row : rows_) print_line(row.cells, style_of(row.tone));
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  std::filesystem::path partial = path;
  partial += ".partial";
  errno = 0;
  std::ofstream file(partial, std::ios::binary);
  file << content;
  file.close();
  std::error_code error(file ? 0 : errno, std::generic_category());
  if (file) std::filesystem::rename(partial, path, error);
  if (file && !error) return;
  std::error_code ignored;
  std::filesystem::remove(partial, ignored);
  throw WriteFailure(fmt::format("{}: cannot be written: {}", path.string(), error.message()));
}

void note(std::string_view text) {
  static std::set<std::string, std::less<>> said;
  if (!sim::Ranks::launched_first() || !said.emplace(text).second) return;
  fmt::print(stderr, "leeway: note: {}\n", text);
}

Progress::Progress(std::string label)
    : label_(std::move(label)),
      is_terminal_(sim::Ranks::launched_first() && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

void Progress::show(double fraction, std::optional<double> remaining_s) {
  constexpr int kWidth = 40;
  constexpr auto kRedraw = std::chrono::milliseconds{100};
  const auto now = Clock::now();
  if (!is_terminal_ || now < next_) return;
  next_ = now + kRedraw;
  drawn_ = true;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const std::string bar(static_cast<std::size_t>(std::lround(done * kWidth)), '=');
  const double elapsed_s = std::chrono::duration<double>(now - begin_).count();
  const double to_go_s = remaining_s.value_or(elapsed_s * (1.0 - done) / std::max(done, 1e-6));
  const auto seconds = std::llround(std::clamp(to_go_s, 0.0, 1e9));
  fmt::print(stderr, "\r{} [{:<{}}] {:3.0f} %, {}:{:02}:{:02} to go \033[K", label_, bar, kWidth,
             100.0 * done, seconds / 3600, seconds / 60 % 60, seconds % 60);
}

}  // namespace leeway::cli
