/// @file
/// A navigator that has fixes every second for five minutes and few from then on: what its claims
/// are worth, just before each fix and between.
#pragma once

#include <array>
#include <cmath>
#include <functional>

#include "sim/atlas/faults/fault_run.hpp"

namespace leeway::sim {

inline constexpr double kDenseS = 300.0;   ///< fixes every second until then
inline constexpr double kSparseS = 300.0;  ///< for so long afterwards few; what is scored

/// The place of an epoch at this time.
inline long epoch_at(double t_s) { return std::lround(t_s / kEpochS); }

/// Sums over epochs of squares, horizontal, velocity and heading by FaultError.
struct ClaimSums {
  double epochs{0.0};
  std::array<double, 3> error_sq{};
  std::array<double, 3> sigma_sq{};
  double beyond_3{0.0};  ///< epochs with an error north or east beyond so many sigmas
  double beyond_5{0.0};

  void add(const FaultEpoch& epoch);
  void add(const ClaimSums& other);
  /// RMS error over RMS claimed sigma; NaN without an epoch.
  double ratio(FaultError e) const;
  double rms(FaultError e) const;
};

/// What one trial leaves.
struct ClaimScore {
  ClaimSums before_fixes{};
  ClaimSums between{};
  /// Never right in the last minute: without a solution, not finite, or beyond 10 m and 10 claimed
  /// sigmas of horizontal position. Or not finite at any time.
  bool lost{false};
  double imu_sigma_scale{1.0};  ///< of health, at the end
};

/// The fixes of which every T-th is left once kDenseS are over.
/// @pre they come every second
void thin_out(FaultInputs& inputs, int fix_interval_s);

/// Runs a navigator on a way of kDenseS + kSparseS.
/// @param inputs       fixes every second, each at the time of an epoch
/// @param before_fix   called, too, with each epoch that is just before a fix is used
ClaimScore run_claims(const NavigatorConfig& config, FaultInputs inputs, const TrueDrive& way,
                      int fix_interval_s,
                      const std::function<void(const FaultEpoch&)>& before_fix = {});

}  // namespace leeway::sim
