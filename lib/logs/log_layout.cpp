#include "lib/logs/log_layout.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "leeway/earth/error.hpp"
#include "lib/logs/log_source.hpp"

namespace leeway {
namespace {

// More lines than any header; what is longer has no end.
constexpr std::size_t kKeptComments = 256;
constexpr std::int64_t kMaxHeadLines = 100'000;

}  // namespace

LogHead read_head(LineReader& lines) {
  LogHead head;
  while (const auto line = lines.next()) {
    head.is_binary = line->find('\0') != std::string_view::npos;
    if (head.is_binary || !is_blank_or_comment(*line)) {
      head.line = *line;
      lines.unread();
      head.bytes = lines.preview();
      break;
    }
    if (head.comments.size() < kKeptComments) head.comments.emplace_back(*line);
    if (lines.line_number() >= kMaxHeadLines) {
      throw Error(lines.path() + ": " + std::to_string(kMaxHeadLines) +
                  " lines of comments or blanks and no data: this is no log");
    }
  }
  return head;
}

std::string first_line(LineReader& lines, const std::string& expected) {
  const LogHead head = read_head(lines);
  if (head.is_binary) {
    throw Error(lines.path() +
                ": is a binary file, which is not read: convert it to CSV by the recorder's tools");
  }
  if (!head.line.empty()) return head.line;
  const std::string what =
      lines.damage().empty() ? lines.path() + ": the file is empty" : lines.damage();
  throw Error(what + "; expected " + expected);
}

bool is_bare_numbers(std::string_view line) {
  const auto fields = split_fields(line, Separator::kRuns);
  return !fields.empty() && is_number(fields.front()) && line.find(',') == std::string_view::npos;
}

}  // namespace leeway
