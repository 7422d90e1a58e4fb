/// @file
/// One covariance for every benchmark of a kernel: that of a filter at work, its noise, a fix.
#pragma once

#include "bench/motion.hpp"
#include "leeway/filters/covariance.hpp"
#include "leeway/filters/covariance_kernel.hpp"

namespace leeway::test {

inline constexpr ProcessNoise kBenchNoise{1e-8, 1e-6, 1e-9, 1e-12};

/// Phi of a number of increments.
inline Transition bench_transition(int increments) {
  Transition Phi;
  for (int k = 0; k < increments; ++k) advance(Phi, bench_dynamics());
  return Phi;
}

inline ErrorMatrix bench_covariance() {
  ErrorVector sigma;
  sigma << Eigen::Vector3d::Constant(0.01), Eigen::Vector3d::Constant(0.1),
      Eigen::Vector3d::Constant(2.0), Eigen::Vector3d::Constant(0.05),
      Eigen::Vector3d::Constant(1e-3);
  ErrorMatrix P = sigma.cwiseAbs2().asDiagonal();
  propagate(P, bench_transition(200), kBenchNoise);  // so that no correlation is zero
  return P;
}

/// Position and velocity of an antenna beside the IMU, whitened.
inline MeasurementRows bench_fix_rows() {
  const Eigen::Matrix3d C_eb = bench_start().nav.q_eb.toRotationMatrix();
  const Eigen::Vector3d lever_b_m(0.5, 0.3, -1.2);
  const ImuIncrement inc = bench_increment();
  const Eigen::Vector3d omega_b_radps = inc.dtheta_b_rad / inc.dt_s;
  MeasurementRows H = MeasurementRows::Zero(6, kErrorStates);
  H.block<3, 3>(0, kPsi) = -skew(C_eb * lever_b_m);
  H.block<3, 3>(0, kDr).setIdentity();
  H.block<3, 3>(3, kPsi) = -skew(C_eb * omega_b_radps.cross(lever_b_m));
  H.block<3, 3>(3, kDv).setIdentity();
  H.block<3, 3>(3, kBg) = C_eb * skew(lever_b_m);
  H.topRows<3>() /= 2.0;
  H.bottomRows<3>() /= 0.05;
  return H;
}

}  // namespace leeway::test
