/// @file
/// Monte Carlo of the whole filter on a simulated scene: do its errors have the size it claims?
#pragma once

#include <cstdint>
#include <functional>

#include "leeway/filters/ekf.hpp"
#include "leeway/sim/gnss_simulator.hpp"
#include "leeway/sim/trajectory.hpp"

namespace leeway::sim {

struct MonteCarloConfig {
  EkfConfig filter{};   ///< what the filter believes
  ImuErrorModel imu{};  ///< what the sensors are
  GnssErrorModel gnss{};
  InitialSigma initial{};  ///< of the drawn initial errors, and what the filter is told
  double imu_rate_hz{50.0};
  double gnss_interval_s{1.0};
  double duration_s{1200.0};
  double score_last_s{480.0};  ///< pre-fix epochs this close to the end are scored
  int trials{200};
  std::uint64_t first_seed{1};  ///< trial k has seed first_seed + k
};

/// Ratios are RMS over trials and epochs to the mean claimed variance's root: 1 when honest.
struct MonteCarloResult {
  double rms_horizontal_m{};    ///< before a fix: sqrt of mean squared north + east error
  double sigma_horizontal_m{};  ///< what the filter claims for it
  double rms_over_sigma{};
  double mean_nees{};  ///< 15 states, before a fix, over trials and epochs
  /// 95 % band of the mean for a consistent filter, as from one epoch per trial: the epochs of a
  /// trial are correlated.
  double nees_low{};
  double nees_high{};
};

/// Trials run on all processors; the result does not depend on how many.
/// @param progress  called with the fraction done, from the calling thread
/// @throws Error when a configuration is invalid.
MonteCarloResult monte_carlo(const Trajectory& trajectory, const MonteCarloConfig& config,
                             const std::function<void(double fraction)>& progress = {});

}  // namespace leeway::sim
