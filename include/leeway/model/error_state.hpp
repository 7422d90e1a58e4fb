/// @file
/// The 15 error states: order, sign and units. Every F, H, output column and test uses this file.
///
///   psi_e  attitude, rad, ECEF axes      C_eb(true) = exp([psi_e x]) C_eb(estimate)
///   dv_e   velocity, m/s, ECEF axes      x = truth - estimate, here and below
///   dr_e   position, m, ECEF axes
///   b_a    accelerometer bias, m/s^2, body axes
///   b_g    gyro bias, rad/s, body axes
#pragma once

#include <Eigen/Core>

#include "leeway/strapdown/nav_state.hpp"

namespace leeway {

inline constexpr int kErrorStates = 15;
inline constexpr int kPsi = 0;
inline constexpr int kDv = 3;
inline constexpr int kDr = 6;
inline constexpr int kBa = 9;
inline constexpr int kBg = 12;

using ErrorVector = Eigen::Matrix<double, kErrorStates, 1>;
using ErrorMatrix = Eigen::Matrix<double, kErrorStates, kErrorStates>;

/// Sensor biases as the filter sees them: measured = true + bias + noise.
struct ImuBias {
  Eigen::Vector3d b_a_mps2{Eigen::Vector3d::Zero()};
  Eigen::Vector3d b_g_radps{Eigen::Vector3d::Zero()};
};

/// The estimate of a filter: the navigation state and the sensor biases.
struct Estimate {
  NavState nav{};
  ImuBias bias{};
};

/// Correction of the estimate by x, so that difference(corrected, original) = x.
void inject(Estimate& estimate, const ErrorVector& x);

/// The error x = truth - estimate, as defined above; |psi_e| <= pi.
ErrorVector difference(const Estimate& truth, const Estimate& estimate);

/// The attitude block of the reset Jacobian d difference(truth, corrected) / d x at x = x_hat,
/// where x_hat has been injected. All other blocks are those of the identity.
Eigen::Matrix3d reset_jacobian(const ErrorVector& x_hat);

}  // namespace leeway
