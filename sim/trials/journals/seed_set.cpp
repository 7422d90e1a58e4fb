#include "sim/trials/journals/seed_set.hpp"

#include <algorithm>
#include <iterator>

namespace leeway::sim {

bool SeedSet::insert(std::uint64_t seed) {
  const auto after = counts_.upper_bound(seed);
  const bool extends_next = after != counts_.end() && after->first == seed + 1;
  if (after != counts_.begin()) {
    const auto before = std::prev(after);
    const std::uint64_t offset = seed - before->first;
    if (offset < before->second) return false;
    if (offset == before->second) {
      before->second += extends_next ? 1 + after->second : 1;
      if (extends_next) counts_.erase(after);
      return true;
    }
  }
  const std::uint64_t count = extends_next ? 1 + after->second : 1;
  if (extends_next) counts_.erase(after);
  counts_.emplace(seed, count);
  return true;
}

std::vector<SeedRange> SeedSet::missing(const SeedRange& range) const {
  std::vector<SeedRange> gaps;
  std::uint64_t from = range.first;
  const std::uint64_t end = range.first + range.count;
  auto held = counts_.upper_bound(from);
  if (held != counts_.begin()) --held;
  for (; held != counts_.end() && held->first < end; ++held) {
    if (held->first > from) gaps.push_back({from, held->first - from});
    from = std::max(from, held->first + held->second);
  }
  if (from < end) gaps.push_back({from, end - from});
  return gaps;
}

}  // namespace leeway::sim
