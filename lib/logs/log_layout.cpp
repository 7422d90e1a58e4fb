#include "lib/logs/log_layout.hpp"

#include "leeway/earth/error.hpp"
#include "lib/logs/log_source.hpp"

namespace leeway {

LogHead read_head(LineReader& lines) {
  LogHead head;
  while (const auto line = lines.next()) {
    if (!is_blank_or_comment(*line)) {
      head.line = *line;
      lines.unread();
      break;
    }
    head.comments.emplace_back(*line);
  }
  return head;
}

std::string first_line(LineReader& lines, const std::string& expected) {
  const LogHead head = read_head(lines);
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
