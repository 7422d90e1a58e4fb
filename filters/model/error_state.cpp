#include "leeway/model/error_state.hpp"

#include "leeway/earth/rotation.hpp"

namespace leeway {

void inject(Estimate& estimate, const ErrorVector& x) {
  NavState& nav = estimate.nav;
  nav.q_eb = turned(x.segment<3>(kPsi), nav.q_eb, Eigen::Vector3d::Zero());
  nav.v_e_mps += x.segment<3>(kDv);
  nav.r_e_m += x.segment<3>(kDr);
  estimate.bias.b_a_mps2 += x.segment<3>(kBa);
  estimate.bias.b_g_radps += x.segment<3>(kBg);
}

ErrorVector difference(const Estimate& truth, const Estimate& estimate) {
  ErrorVector x;
  x.segment<3>(kPsi) = log_quaternion(truth.nav.q_eb * estimate.nav.q_eb.conjugate());
  x.segment<3>(kDv) = truth.nav.v_e_mps - estimate.nav.v_e_mps;
  x.segment<3>(kDr) = truth.nav.r_e_m - estimate.nav.r_e_m;
  x.segment<3>(kBa) = truth.bias.b_a_mps2 - estimate.bias.b_a_mps2;
  x.segment<3>(kBg) = truth.bias.b_g_radps - estimate.bias.b_g_radps;
  return x;
}

Eigen::Matrix3d reset_jacobian(const ErrorVector& x_hat) {
  // exp(psi_hat + d) exp(-psi_hat) = exp(J_l(psi_hat) d) to first order in d.
  return left_jacobian(x_hat.segment<3>(kPsi));
}

}  // namespace leeway
