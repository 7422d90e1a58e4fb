#include "leeway/logs/log_summary.hpp"

#include <numeric>
#include <utility>

namespace leeway {

std::int64_t LogSummary::damaged_lines() const {
  return std::accumulate(damaged.begin(), damaged.end(), std::int64_t{0});
}

void LogSummary::add_damage(LineDamage reason, std::string message) {
  ++damaged[static_cast<std::size_t>(reason)];
  if (messages.size() < kMaxMessages) messages.push_back(std::move(message));
}

}  // namespace leeway
