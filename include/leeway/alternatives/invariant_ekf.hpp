/// @file
/// The invariant extended Kalman filter: the error of attitude, velocity and position as one
/// element of the group SE_2(3), left-invariant.
#pragma once

#include "leeway/covariance/transition.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/model/error_state.hpp"

namespace leeway {

/// Left-invariant error, resolved in Earth-fixed axes, of the state (C_eb, v_e + omega_ie x r_e,
/// r_e): velocity and position errors are seen from the estimated body, which turns with every
/// correction of its attitude. To first order it is the error of error_state.hpp, in its order and
/// units, so F, H and P are shared with it. Biases stay outside of the group.
/// Source: Barrau and Bonnabel (2017); the velocity by Brossard et al. (2022), section III.
/// docs/theory/alternatives/invariant_ekf.md.
struct InvariantError {
  /// The exponential map: the error x = difference(truth, estimate) whose invariant error is xi.
  static ErrorVector correction(const ErrorVector& xi);

  /// The logarithm, which undoes correction(): the invariant error of x. @pre |psi_e| <= pi.
  static ErrorVector coordinates(const ErrorVector& x);

  /// What the correction by xi_hat makes of the error that remains: it turns with the attitude.
  static Transition reset(const ErrorVector& xi_hat);
};

/// BasicEkf on the invariant error. covariance() is that of the invariant error, and to first
/// order of the error of error_state.hpp.
template <CovarianceKernel Kernel>
using InvariantEkf = BasicEkf<Kernel, InvariantError>;

}  // namespace leeway
