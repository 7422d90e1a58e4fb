/// @file
/// Scenes for the covariance kernels, and how far one is from another.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cstdint>

#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/covariance/transition.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/sim/tools/random.hpp"
#include "tests/filters/model/random_state.hpp"

namespace leeway::test {

/// A random attitude, place and force of 20 m/s^2 at most; biases of the given times.
inline ErrorDynamics random_dynamics(std::uint64_t seed, double dt_s, double tau_s) {
  sim::Random random(seed, 6);
  const Estimate e = random_estimate(seed);
  ErrorDynamics step;
  step.dt_s = dt_s;
  step.C_eb_mean = e.nav.q_eb.toRotationMatrix();
  step.dv_f_e_mps = dt_s * random_vector(random, 20.0);
  step.gravity_gradient_e = gravity_gradient_e(e.nav.r_e_m);
  step.a_a = bias_decay(dt_s, tau_s);
  step.g_g = bias_decay(dt_s, 2.0 * tau_s);
  return step;
}

/// Position and velocity of an antenna 1 m from the IMU, which turns at 0.5 rad/s, whitened.
inline MeasurementRows antenna_rows(const Eigen::Matrix3d& C_eb, double position_m,
                                    double velocity_mps) {
  const Eigen::Vector3d lever_b_m(0.6, -0.64, 0.48);
  const Eigen::Vector3d omega_b_radps(0.1, 0.2, 0.44);
  MeasurementRows H = MeasurementRows::Zero(kMaxRows, kErrorStates);
  H.block<3, 3>(0, kPsi) = -skew(C_eb * lever_b_m);
  H.block<3, 3>(0, kDr).setIdentity();
  H.block<3, 3>(3, kPsi) = -skew(C_eb * omega_b_radps.cross(lever_b_m));
  H.block<3, 3>(3, kDv).setIdentity();
  H.block<3, 3>(3, kBg) = C_eb * skew(lever_b_m);
  H.topRows<3>() /= position_m;
  H.bottomRows<3>() /= velocity_mps;
  return H;
}

inline ErrorMatrix prior(double psi, double dv, double dr, double b_a, double b_g) {
  return jacobian_steps(psi, dv, dr, b_a, b_g).cwiseAbs2().asDiagonal();
}

/// Sigmas of a filter at work: rad, m/s, m, m/s^2, rad/s.
inline ErrorVector working_sigmas() { return jacobian_steps(1e-2, 0.1, 2.0, 0.05, 1e-3); }

inline ErrorMatrix random_covariance(std::uint64_t seed) {
  sim::Random random(seed, 5);
  ErrorMatrix A;
  for (double& a : A.reshaped()) a = random.normal();
  const ErrorMatrix S = working_sigmas().asDiagonal() * A;
  const ErrorMatrix P = S * S.transpose();
  return 0.5 * (P + P.transpose());
}

inline bool positive_definite(const ErrorMatrix& P) {
  // Scaled to a unit diagonal, so that units do not decide.
  if (!(P.diagonal().minCoeff() > 0.0) || !P.allFinite()) return false;
  const ErrorVector d = P.diagonal().cwiseSqrt().cwiseInverse();
  const ErrorMatrix scaled = d.asDiagonal() * P * d.asDiagonal();
  return Eigen::LLT<ErrorMatrix>(scaled).info() == Eigen::Success;
}

}  // namespace leeway::test
