/// @file
/// Runs the built program on several ranks.
#pragma once

#include <cstdlib>
#include <string>

namespace leeway::test {

/// Whether the program was built with MPI and there is an mpirun.
inline bool has_mpi() {
#ifdef LEEWAY_HAS_MPI
  return std::system("mpirun --version >/dev/null 2>&1") == 0;
#else
  return false;
#endif
}

/// What goes in front of the program.
inline std::string mpirun(int ranks) {
  return "mpirun --allow-run-as-root --oversubscribe -n " + std::to_string(ranks) + " ";
}

}  // namespace leeway::test
