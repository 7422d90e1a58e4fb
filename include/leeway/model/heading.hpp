/// @file
/// The heading in an estimate: what it is, how well it is known, whether a standstill can tell it.
#pragma once

#include <Eigen/Core>

#include "leeway/model/error_state.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway {

/// The direction over ground of a vector, clockwise from true north, and its change with the
/// vector. What a change of place does to north is left out: tan(latitude) / 6370 km.
struct Azimuth {
  /// @param forward_e  ECEF: a unit vector, or a velocity. @param r_e_m  the place, on the Earth
  Azimuth(const Eigen::Vector3d& forward_e, const Eigen::Vector3d& r_e_m);
  /// @param C_en  ned_to_ecef() of the place
  Azimuth(const Eigen::Vector3d& forward_e, const Eigen::Matrix3d& C_en);

  /// Whether it can be told of a unit vector: near the vertical, 10 deg, tilt changes it too much.
  bool is_defined() const { return level_part > 0.17; }

  double level_part;      ///< length of the vector's horizontal part
  double angle_rad{0.0};  ///< 0 where the vector is vertical, as the change is
  Eigen::Vector3d gradient_e{Eigen::Vector3d::Zero()};  ///< d angle_rad / d forward_e, level
};

/// Variance of a turn about the local vertical: of the heading, rad^2.
double heading_variance_rad2(const Estimate& estimate, const ErrorMatrix& P);

/// 1 sigma of the same; 0 where the variance is negative.
double heading_sigma_rad(const Estimate& estimate, const ErrorMatrix& P);

/// Whether a standstill cannot tell the heading better than it is known: the rate of the Earth that
/// would tell it is hidden in the gyro's bias.
bool rest_hides_heading(const ImuErrorModel& imu, const Estimate& estimate, const ErrorMatrix& P);

}  // namespace leeway
