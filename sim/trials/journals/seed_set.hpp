/// @file
/// Which trials of a campaign are finished, in memory that follows the gaps, not the trials.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "leeway/sim/trials/seed_range.hpp"

namespace leeway::sim {

/// A set of seeds as ranges that do not touch.
class SeedSet {
 public:
  /// @returns whether the seed is new.
  bool insert(std::uint64_t seed);

  /// What of a range the set does not hold, ascending.
  std::vector<SeedRange> missing(const SeedRange& range) const;

 private:
  std::map<std::uint64_t, std::uint64_t> counts_{};  // by first seed
};

}  // namespace leeway::sim
