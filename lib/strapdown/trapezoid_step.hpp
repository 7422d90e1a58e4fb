/// @file
/// The step by the mean of both ends' attitude and velocity. Private to the strapdown.
#pragma once

#include "leeway/earth/rotation.hpp"
#include "lib/strapdown/earth_terms.hpp"

namespace leeway::schemes {

template <GravityModel gravity, EarthRotation rotation>
StrapdownStep trapezoid_step(NavState& state, const ImuIncrement& inc, ImuHistory&) {
  const Eigen::Matrix3d C_old = state.q_eb.toRotationMatrix();
  state.q_eb = turned(about_z_e(-inc.dt_s * kTurnRadps<rotation>), state.q_eb, inc.dtheta_b_rad);
  const Eigen::Matrix3d C_mean = 0.5 * (C_old + state.q_eb.toRotationMatrix());
  const Eigen::Vector3d dv_f_e = C_mean * inc.dv_b_mps;
  const Eigen::Vector3d dv_e = vector(velocity_change<gravity, rotation>(
      triple(state.r_e_m), triple(state.v_e_mps), triple(dv_f_e), inc.dt_s));
  state.r_e_m += inc.dt_s * (state.v_e_mps + 0.5 * dv_e);
  state.v_e_mps += dv_e;
  return {C_mean, dv_f_e};
}

}  // namespace leeway::schemes
