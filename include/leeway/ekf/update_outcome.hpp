/// @file
/// What is said to a filter with a measurement, and what it answers.
#pragma once

#include <Eigen/Core>

#include "leeway/earth/time.hpp"

namespace leeway {

/// Answer of a filter to a measurement.
struct UpdateOutcome {
  enum class Outcome { kFused, kGated, kUnusable };
  Outcome outcome{Outcome::kUnusable};
  Time time{};
  int dof{0};                ///< components of the fix
  double nis{0.0};           ///< normalized innovation squared of the whole fix, by its own R
  double gate{0.0};          ///< the NIS above which it is refused
  double position_nis{0.0};  ///< of a fix's position alone, 3 components; else 0
  double velocity_nis{0.0};
  Eigen::Vector3d position_innovation_e_m{Eigen::Vector3d::Zero()};
  Eigen::Vector3d velocity_innovation_e_mps{Eigen::Vector3d::Zero()};
  double log_det_S{0.0};           ///< of the innovation's covariance; with the NIS, the likelihood
  /// The whole fix was refused, and its position or its velocity alone corrected the state.
  bool fused_in_part{false};
  bool covariance_positive{true};  ///< no diagonal element and no innovation variance <= 0
};

/// Directions that an update leaves as they are, estimate and variance, while their uncertainty
/// counts: a Schmidt update. At rest a linearized filter takes the noise of its own estimate for
/// motion, and that for knowledge of the heading.
enum class Held {
  kNothing,
  kHeading,
  kHeadingAndTurn,  ///< and the gyro bias about the vertical
};

/// Trust in a fix beyond its own R: factors on the standard deviations of position and velocity,
/// and the directions that it cannot tell.
struct FixTrust {
  double position_sigma_scale{1.0};
  double velocity_sigma_scale{1.0};
  Held held{Held::kNothing};
  bool is_white{false};  ///< the position's error is its own, whatever the configuration says
};

}  // namespace leeway
