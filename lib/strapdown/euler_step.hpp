/// @file
/// The seed's explicit Euler step and the semi-implicit one. Private to the strapdown.
#pragma once

#include "leeway/earth/rotation.hpp"
#include "lib/strapdown/earth_terms.hpp"

namespace leeway::schemes {

/// [seed (3)-(8)]; the semi-implicit variant takes the position from the new velocity.
template <bool position_from_new_velocity, GravityModel gravity, EarthRotation rotation>
StrapdownStep euler_step(NavState& state, const ImuIncrement& inc, ImuHistory&) {
  const Eigen::Vector3d turn_e = about_z_e(kTurnRadps<rotation>);
  const Eigen::Vector3d coriolis_e = about_z_e(2.0 * kCoriolisRadps<rotation>);
  const Eigen::Matrix3d C_eb = state.q_eb.toRotationMatrix();
  const Eigen::Vector3d dtheta_eb_b =
      inc.dtheta_b_rad - inc.dt_s * (C_eb.transpose() * turn_e);  // [seed (3)]
  const Eigen::Vector3d dv_f_e = C_eb * inc.dv_b_mps;             // [seed (4)]
  const Eigen::Vector3d v_old_e = state.v_e_mps;
  state.v_e_mps += dv_f_e + inc.dt_s * (gravity_e<gravity>(state.r_e_m) -
                                        coriolis_e.cross(v_old_e));  // [seed (5)-(7)]
  state.r_e_m += inc.dt_s * (position_from_new_velocity ? state.v_e_mps : v_old_e);  // [seed (8)]
  state.q_eb = turned(Eigen::Vector3d::Zero(), state.q_eb, dtheta_eb_b);
  return {C_eb, dv_f_e};
}

}  // namespace leeway::schemes
