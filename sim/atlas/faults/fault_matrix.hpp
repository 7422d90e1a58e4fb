/// @file
/// The matrix of faults: each on each vehicle, and whether the navigator says so when it is wrong,
/// and finds back.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "sim/atlas/faults/fault.hpp"
#include "sim/atlas/faults/regime.hpp"

namespace leeway::sim {

inline constexpr double kBearableSilenceS = 2.0;

/// One fault on one vehicle. Wrong is beyond 5 claimed sigmas in horizontal position, velocity or
/// heading.
struct FaultCell {
  std::size_t fault{};   ///< its place in faults()
  std::size_t regime{};  ///< in regimes()
  /// Wrong, and health is not aligned, or the time of the solution stands still. A state that the
  /// navigator would also have without the fault, once it has settled, tells nothing.
  double told_s{0.0};
  double silent_s{0.0};  ///< wrong, and nothing says so
  std::array<double, 3> silent_by_s{};  ///< ... by what is wrong, a FaultError
  bool finite{true};
  double worst_m{0.0};  ///< horizontal error during the fault
  /// From the end of the fault until the error is within 5 sigma and 3 floors for good; absent when
  /// it is not, and where nothing ends.
  std::optional<double> recovery_s{};

  bool is_silent() const { return !finite || silent_s > kBearableSilenceS; }
};

/// What a navigator does without a fault.
struct FaultFloor {
  double aligned_s{};     ///< from here on it is aligned for good; infinite: never
  double horizontal_m{};  ///< RMS error once it has settled
  double beyond_s{};      ///< time beyond 5 sigma once it has settled
};

struct FaultMatrix {
  std::vector<FaultFloor> floors{};  ///< by regime
  std::vector<FaultCell> cells{};    ///< by fault, then regime
};

/// Whether no navigator could tell this fault with what this vehicle carries.
bool is_unknowable(const FaultCell& cell);

struct FaultSummary {
  std::size_t cells{0};
  std::size_t silent{0};      ///< of what could be told
  std::size_t unknowable{0};  ///< silent, where nobody could tell
  std::size_t not_finite{0};
  std::size_t ending{0};  ///< cells whose fault ends
  std::size_t recovered{0};
  double recovery_95_s{0.0};  ///< of 95 % of the recovered ones

  double silent_share() const {
    return cells == 0 ? 0.0 : static_cast<double>(silent) / static_cast<double>(cells);
  }
};

/// Runs the matrix. The same bits on any number of threads.
/// @param brief    every fault on the car, three on the others
/// @param threads  0: as many as there are processors
FaultMatrix run_fault_matrix(bool brief, int threads = 0,
                             const std::function<void(double fraction)>& progress = {});

FaultSummary summary_of(const FaultMatrix& matrix);

}  // namespace leeway::sim
