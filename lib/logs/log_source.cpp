#include "lib/logs/log_source.hpp"

#include <algorithm>

namespace leeway {
namespace {

constexpr std::size_t kMaxQuotedBytes = 48;
constexpr Duration kWeek = std::chrono::weeks{1};
constexpr Duration kNearWeekEnd = std::chrono::hours{1};

// The offending text, cut short and safe to print.
std::string quoted(std::string_view text) {
  std::string quote(text.substr(0, kMaxQuotedBytes));
  std::replace_if(
      quote.begin(), quote.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return "'" + quote + (text.size() > kMaxQuotedBytes ? "...'" : "'");
}

}  // namespace

bool is_blank_or_comment(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  return first == std::string_view::npos || line[first] == '#' || line[first] == '%';
}

std::string damage_message(const LineReader& lines, std::string_view line, const Fault& fault) {
  const auto column = fault.text.data() - line.data() + 1;
  return lines.path() + ":" + std::to_string(lines.line_number()) + ":" + std::to_string(column) +
         ": " + std::string(name(fault.reason)) + ": " + quoted(fault.text);
}

std::string damage_message(const MessageReader& messages, std::string_view message,
                           const Fault& fault) {
  const bool is_named = !fault.text.empty() && fault.text.data() != message.data();
  return messages.path() + ": byte " + std::to_string(messages.offset()) + ": " +
         std::string(name(fault.reason)) + (is_named ? ": " + std::string(fault.text) : "");
}

Time WeekUnroller::unroll(Time time_of_week) {
  const auto is_in_week = [](Time t) {
    return t.time_since_epoch() >= Duration{0} && t.time_since_epoch() <= kWeek;
  };
  if (last_ && is_in_week(*last_) && is_in_week(time_of_week)) {
    const Duration step = time_of_week - *last_;
    if (step < -kWeek + 2 * kNearWeekEnd) offset_ += kWeek;
    if (step > kWeek - 2 * kNearWeekEnd) offset_ -= kWeek;
  }
  last_ = time_of_week;
  return time_of_week + offset_;
}

}  // namespace leeway
