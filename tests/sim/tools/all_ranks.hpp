/// @file
/// The ranks that a test program runs on: one, unless mpirun started it.
#pragma once

#include "leeway/sim/tools/ranks.hpp"

namespace leeway::test {

/// Started once: MPI cannot be started again in a process.
inline const sim::Ranks& all_ranks() {
  static const sim::Ranks ranks;
  return ranks;
}

}  // namespace leeway::test
