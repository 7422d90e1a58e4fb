#include "leeway/strapdown/nav_state.hpp"

namespace leeway {

NavState nav_state_from_ned(const NavStateNed& ned) {
  const Eigen::Matrix3d C_en = ned_to_ecef(ned.position);
  NavState state;
  state.time = ned.time;
  state.q_eb = Eigen::Quaterniond(C_en * rotation_from_euler(ned.attitude)).normalized();
  state.v_e_mps = C_en * ned.v_n_mps;
  state.r_e_m = ecef_from_geodetic(ned.position);
  return state;
}

NavStateNed ned_from_nav_state(const NavState& state) {
  NavStateNed ned;
  ned.time = state.time;
  ned.position = geodetic_from_ecef(state.r_e_m);
  const Eigen::Matrix3d C_ne = ned_to_ecef(ned.position).transpose();
  ned.v_n_mps = C_ne * state.v_e_mps;
  ned.attitude = euler_from_rotation(C_ne * state.q_eb.toRotationMatrix());
  return ned;
}

}  // namespace leeway
