/// @file
/// Counts heap allocations, to prove that a hot path makes none. Replaces the global operator new
/// of the program it is linked into, and, by the linker's --wrap, malloc and its kin in everything
/// linked statically: that is where Eigen's dynamic sizes come from.
#pragma once

#include <cstddef>

namespace leeway::test {

class AllocationCounter {
 public:
  AllocationCounter();

  /// Allocations, on any thread, since construction.
  std::size_t count() const;

 private:
  std::size_t start_;
};

}  // namespace leeway::test
