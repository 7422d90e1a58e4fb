/// @file
/// A navigation solution with its uncertainty: what a filter says at one time.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "leeway/strapdown/nav_state.hpp"

namespace leeway {

/// Solution at one time. Every sigma is one standard deviation, as the filter estimates it.
struct Solution {
  NavState nav{};                                                 ///< of the IMU
  Eigen::Vector3d b_a_mps2{Eigen::Vector3d::Zero()};              ///< accelerometer bias, body axes
  Eigen::Vector3d b_g_radps{Eigen::Vector3d::Zero()};             ///< gyro bias, body axes
  Eigen::Vector3d sigma_position_n_m{Eigen::Vector3d::Zero()};    ///< north, east, down
  Eigen::Vector3d sigma_velocity_n_mps{Eigen::Vector3d::Zero()};  ///< north, east, down
  Eigen::Vector3d sigma_attitude_rad{Eigen::Vector3d::Zero()};    ///< roll, pitch, yaw
  Eigen::Vector3d sigma_b_a_mps2{Eigen::Vector3d::Zero()};
  Eigen::Vector3d sigma_b_g_radps{Eigen::Vector3d::Zero()};
  double nis{std::numeric_limits<double>::quiet_NaN()};  ///< of the fix since the solution before
  int nis_dof{0};  ///< dimension of that fix; 0 and a NaN nis where there was none
};

}  // namespace leeway
