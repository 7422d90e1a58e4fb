/// @file
/// How an IMU is mounted in its vehicle, told from gravity and the way the vehicle goes.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/time.hpp"
#include "leeway/navigator/heading_bank.hpp"

namespace leeway {

/// Of filters whose body axes are the sensor's. Forward is where the vehicle goes when it goes fast
/// and straight; down is where gravity pulls, once the slope of the road is taken out along
/// forward. A vehicle that reverses slower than 5 m/s is not mistaken. No heap, no exceptions.
class MountEstimator {
 public:
  static constexpr double kMinSpeedMps = 5.0;
  static constexpr double kMaxTurnRadps = 0.05;
  static constexpr double kMaxHeadingSigmaRad = 0.1;
  static constexpr double kEnoughS = 3.0;

  /// After a fix has been fused. What counts is the heading of the whole bank.
  void push(const HeadingBank& bank);

  /// Sensor axes to body axes (forward, right, down), once it is known to a few degrees.
  std::optional<Eigen::Matrix3d> C_bs() const;

  template <class Archive>
  void visit(Archive& archive) {
    archive(forward_s_, down_s_, seen_s_, previous_);
  }

 private:
  Eigen::Vector3d forward_s_{Eigen::Vector3d::Zero()};  // sums of unit vectors
  Eigen::Vector3d down_s_{Eigen::Vector3d::Zero()};
  double seen_s_{0.0};
  std::optional<Time> previous_{};
};

}  // namespace leeway
