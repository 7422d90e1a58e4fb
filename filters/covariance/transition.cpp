#include "leeway/covariance/transition.hpp"

#include <cmath>

#include "filters/covariance/increment_transition.hpp"
#include "filters/covariance/lanes.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway {

double bias_decay(double dt_s, double tau_s) {
  return std::isinf(tau_s) ? 1.0 : std::exp(-dt_s / tau_s);
}

void advance(Transition& Phi, const ErrorDynamics& step) {
  using lanes::kCount;
  using lanes::load;
  using lanes::store;
  using lanes::unrolled;
  const lanes::StepRows<double> rows(step);
  constexpr int kColumns = Transition::Rows::ColsAtCompileTime;
  unrolled<kColumns / kCount<double>>([&](auto block) __attribute__((always_inline)) {
    constexpr int kStart = block * kCount<double>;
    const auto bias_row = [](int bias, double decay) __attribute__((always_inline)) {
      return lanes::only<double>(bias - kStart, lanes::VectorOf<double>{} + decay);
    };
    lanes::Column<double> in;
    lanes::Column<double> out;
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      in[kPsi + i] = load(&Phi.psi(int{i}, kStart));
      in[kDv + i] = load(&Phi.v(int{i}, kStart));
      in[kDr + i] = load(&Phi.r(int{i}, kStart));
      in[kBa + i] = bias_row(kBa + i, Phi.a_a);
      in[kBg + i] = bias_row(kBg + i, Phi.g_g);
    });
    rows.attitude(in, out);
    rows.velocity(in, out);
    rows.position(in, out);
    unrolled<3>([&](auto i) __attribute__((always_inline)) {
      store<double>(&Phi.psi(int{i}, kStart), out[kPsi + i]);
      store<double>(&Phi.v(int{i}, kStart), out[kDv + i]);
      store<double>(&Phi.r(int{i}, kStart), out[kDr + i]);
    });
  });
  Phi.a_a *= step.a_a;
  Phi.g_g *= step.g_g;
  Phi.dt_s += step.dt_s;
}

Transition compose(const Transition& later, const Transition& earlier) {
  const Transition& e = earlier;
  const auto product = [&e](const Transition::Rows& rows) {
    Transition::Rows result = rows.middleCols<3>(kPsi) * e.psi + rows.middleCols<3>(kDv) * e.v +
                              rows.middleCols<3>(kDr) * e.r;
    result.middleCols<3>(kBa) += e.a_a * rows.middleCols<3>(kBa);
    result.middleCols<3>(kBg) += e.g_g * rows.middleCols<3>(kBg);
    return result;
  };
  Transition Phi;
  Phi.dt_s = later.dt_s + e.dt_s;
  Phi.psi = product(later.psi);
  Phi.v = product(later.v);
  Phi.r = product(later.r);
  Phi.a_a = later.a_a * e.a_a;
  Phi.g_g = later.g_g * e.g_g;
  return Phi;
}

ErrorMatrix system_matrix(const Eigen::Matrix3d& C_eb, const Eigen::Vector3d& f_e_mps2,
                          const Eigen::Matrix3d& gravity_gradient_e, double tau_a_s,
                          double tau_g_s) {
  const Eigen::Matrix3d Omega_ie = skew(earth_rotation_e_radps());
  ErrorMatrix F = ErrorMatrix::Zero();
  F.block<3, 3>(kPsi, kPsi) = -Omega_ie;
  F.block<3, 3>(kPsi, kBg) = -C_eb;
  F.block<3, 3>(kDv, kPsi) = -skew(f_e_mps2);
  F.block<3, 3>(kDv, kDv) = -2.0 * Omega_ie;
  F.block<3, 3>(kDv, kDr) = gravity_gradient_e;
  F.block<3, 3>(kDv, kBa) = -C_eb;
  F.block<3, 3>(kDr, kDv).setIdentity();
  F.block<3, 3>(kBa, kBa).diagonal().setConstant(-1.0 / tau_a_s);
  F.block<3, 3>(kBg, kBg).diagonal().setConstant(-1.0 / tau_g_s);
  return F;
}

ErrorMatrix dense(const Transition& Phi) {
  ErrorMatrix M = ErrorMatrix::Zero();
  M.middleRows<3>(kPsi) = Phi.psi.leftCols<kErrorStates>();
  M.middleRows<3>(kDv) = Phi.v.leftCols<kErrorStates>();
  M.middleRows<3>(kDr) = Phi.r.leftCols<kErrorStates>();
  M.block<3, 3>(kBa, kBa).diagonal().setConstant(Phi.a_a);
  M.block<3, 3>(kBg, kBg).diagonal().setConstant(Phi.g_g);
  return M;
}

}  // namespace leeway
