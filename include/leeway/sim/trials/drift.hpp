/// @file
/// The drift study: free-inertial position error from a perfect start at rest, per IMU class. It
/// answers [seed Table 2] and [seed figure 2].
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/sensors/imu_class.hpp"

namespace leeway::sim {

/// Configuration of the drift study.
struct DriftConfig {
  double latitude_deg{45.0};
  double imu_rate_hz{50.0};
  int trials{200};
  std::uint64_t seed{1};
  double max_time_s{2000.0};  ///< a curve ends here, or once past 100 s and 100 m
};

/// Readings of the table.
enum class DriftReading {
  kPaper,  ///< the cells as printed
  /// What reproduces them: the low end of the accelerometer drift on all three axes at once, the
  /// gyro drift left out, no noise, explicit Euler [seed (7)-(8)], 3-D norm.
  kPaperAssumptions,
  /// Per-axis random-constant biases of both sensors and their noise, 3-D RMS over the trials.
  kComplete,
};
constexpr auto names(DriftReading) { return std::array{"paper", "paper_assumptions", "complete"}; }

/// A cell pair of the table: errors in m, 3-D, and time in s. Percentiles are those of single
/// trials; for the other readings they equal the error. NaN where the reading gives none.
struct DriftRow {
  ImuClass imu{};
  RangeEnd range{};
  DriftReading reading{};
  double error_100s_m{};
  double error_100s_p2_5_m{};
  double error_100s_p97_5_m{};
  double time_to_100m_s{};
};

/// Error against time, every second, with its percentiles over the trials.
struct DriftCurve {
  ImuClass imu{};
  RangeEnd range{};
  DriftReading reading{};
  std::vector<double> t_s{};
  std::vector<double> error_m{};
  std::vector<double> p2_5_m{};
  std::vector<double> p97_5_m{};
};

/// Result of the study.
struct DriftStudy {
  std::vector<DriftRow> rows{};      ///< by class; paper, its assumptions, complete low to high
  std::vector<DriftCurve> curves{};  ///< for the last two readings, in the same order
};

/// The study of all IMU classes, on all processors; the result does not depend on how many.
/// @param progress  called with the fraction done, from the calling thread
/// @throws Error when the configuration is out of range: latitude within +-90 deg, rate 1 to
/// 1000 Hz, 2 to 1e6 trials, 101 to 1e5 s.
DriftStudy drift_study(const DriftConfig& config,
                       const std::function<void(double fraction)>& progress = {});

}  // namespace leeway::sim
