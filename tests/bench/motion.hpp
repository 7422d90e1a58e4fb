/// @file
/// One motion for every benchmark of a step: a car in a turn at 45 degrees north, an IMU at 200 Hz.
#pragma once

#include "leeway/covariance/transition.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway::test {

inline Estimate bench_start() {
  Estimate start;
  const Geodetic place{45.0 * kRadPerDeg, 7.0 * kRadPerDeg, 250.0};
  start.nav.r_e_m = ecef_from_geodetic(place);
  start.nav.v_e_mps = ned_to_ecef(place) * Eigen::Vector3d(12.0, 16.0, 0.0);
  start.nav.q_eb = Eigen::Quaterniond(ned_to_ecef(place) * rotation_from_euler({0.01, 0.02, 0.9}));
  return start;
}

inline ImuIncrement bench_increment() {
  constexpr double kDtS = 0.005;
  return {Time{}, kDtS, kDtS * Eigen::Vector3d(0.01, -0.02, 0.4),
          kDtS * Eigen::Vector3d(0.2, 8.0, -9.8)};
}

/// What the increment does to the error.
inline ErrorDynamics bench_dynamics() {
  NavState nav = bench_start().nav;
  ImuHistory history;
  ErrorDynamics dynamics;
  const ImuIncrement inc = bench_increment();
  dynamics.dt_s = inc.dt_s;
  dynamics.gravity_gradient_e = gravity_gradient_e(nav.r_e_m);
  const StrapdownStep step = strapdown_step<>(nav, inc, history);
  dynamics.C_eb_mean = step.C_eb_mean;
  dynamics.dv_f_e_mps = step.dv_f_e_mps;
  return dynamics;
}

}  // namespace leeway::test
