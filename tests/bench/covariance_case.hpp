/// @file
/// One covariance for every benchmark of a kernel: that of a filter at work, its noise, a fix.
#pragma once

#include "leeway/covariance/covariance.hpp"
#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/model/process_noise.hpp"
#include "tests/bench/motion.hpp"
#include "tests/filters/covariance/kernel_cases.hpp"

namespace leeway::test {

inline constexpr ProcessNoise kBenchNoise{1e-8, 1e-6, 1e-9, 1e-12};

/// Phi of a number of increments.
inline Transition bench_transition(int increments) {
  Transition Phi;
  for (int k = 0; k < increments; ++k) advance(Phi, bench_dynamics());
  return Phi;
}

inline ErrorMatrix bench_covariance() {
  ErrorMatrix P = working_sigmas().cwiseAbs2().asDiagonal();
  propagate(P, bench_transition(200), kBenchNoise);  // so that no correlation is zero
  return P;
}

/// Position and velocity of an antenna beside the IMU, whitened.
inline MeasurementRows bench_fix_rows() {
  return antenna_rows(bench_start().nav.q_eb.toRotationMatrix(), 2.0, 0.05);
}

}  // namespace leeway::test
