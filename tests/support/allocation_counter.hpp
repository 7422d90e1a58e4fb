/// @file
/// Counts heap allocations, to prove that a hot path makes none. Replaces the global operator new
/// of the program it is linked into; what Eigen allocates for dynamic sizes bypasses it and is
/// caught by EIGEN_RUNTIME_NO_MALLOC instead.
#pragma once

#include <cstddef>

namespace leeway::test {

class AllocationCounter {
 public:
  AllocationCounter();

  /// Calls of operator new, on any thread, since construction.
  std::size_t count() const;

 private:
  std::size_t start_;
};

}  // namespace leeway::test
