/// @file
/// What an IMU log shows by itself: gravity, its direction, channels that never change, full scale.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "leeway/sensors/imu.hpp"
#include "leeway/sim/inspect/log_look.hpp"
#include "leeway/sim/tools/quantile.hpp"
#include "sim/inspect/record_times.hpp"

namespace leeway::sim {

/// Median of any number of values, in constant memory: of every n-th once there are many.
class ThinnedMedian {
 public:
  void add(double value);
  double median() const { return quantile_of(values_, 0.5); }  ///< NaN of none

 private:
  static constexpr std::size_t kMost = 4096;

  std::vector<double> values_{};
  std::int64_t every_{1};
  std::int64_t count_{0};
};

/// Samples of one sensor that stand at its largest magnitude.
class FullScale {
 public:
  /// @param least  the smallest full scale of such a sensor
  explicit FullScale(double least) : largest_(least) {}
  void add(const Eigen::Vector3d& value);
  std::int64_t samples() const { return count_ >= kFew ? count_ : 0; }

 private:
  static constexpr std::int64_t kFew = 10;  ///< fewer may be chance

  double largest_;
  std::int64_t count_{0};
};

/// The increments of a log, one after the other.
class ImuScan {
 public:
  ImuScan();
  void add(const ImuIncrement& inc);

  /// All but forward_b.
  ImuFigures figures() const;

 private:
  RecordTimes times_{};
  double window_s_{0.0};
  Eigen::Vector3d window_dv_mps_{Eigen::Vector3d::Zero()};
  ThinnedMedian force_mps2_{};
  Eigen::Vector3d force_sum_mps2_{Eigen::Vector3d::Zero()};
  double magnitude_sum_mps2_{0.0};
  std::array<Eigen::Vector3d, 2> least_{};
  std::array<Eigen::Vector3d, 2> most_{};
  FullScale gyro_scale_;
  FullScale accelerometer_scale_;
  std::int64_t count_{0};
};

}  // namespace leeway::sim
