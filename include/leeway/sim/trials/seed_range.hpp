/// @file
/// Seeds that follow each other.
#pragma once

#include <cstdint>

namespace leeway::sim {

/// The seeds first .. first + count - 1.
struct SeedRange {
  std::uint64_t first{};
  std::uint64_t count{};
};

}  // namespace leeway::sim
