#include "leeway/logs/log_summary.hpp"

#include <numeric>
#include <utility>

namespace leeway {

std::string_view name(LineDamage reason) {
  switch (reason) {
    case LineDamage::kNotANumber:
      return "not a number";
    case LineDamage::kMissingField:
      return "missing field";
    case LineDamage::kNotFinite:
      return "not finite";
    case LineDamage::kTimeGoesBack:
      return "time goes back";
    case LineDamage::kDuplicateTime:
      return "time repeated";
    case LineDamage::kTimeJumpsAhead:
      return "time jumps ahead of the lines after it";
    case LineDamage::kOutOfRange:
      return "out of range";
    case LineDamage::kTooLong:
      return "line too long";
  }
  return "";
}

std::int64_t LogSummary::damaged_lines() const {
  return std::accumulate(damaged.begin(), damaged.end(), std::int64_t{0});
}

void LogSummary::add_damage(LineDamage reason, std::string message) {
  ++damaged[static_cast<std::size_t>(reason)];
  if (messages.size() < kMaxMessages) messages.push_back(std::move(message));
}

}  // namespace leeway
