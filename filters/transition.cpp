#include "leeway/filters/transition.hpp"

#include <cmath>

#include "leeway/rotation.hpp"

namespace leeway {
namespace {

/// omega_ie x each column.
Eigen::Matrix3d earth_rate_cross(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d result;
  result.row(0) = -wgs84::kRotationRateRadps * m.row(1);
  result.row(1) = wgs84::kRotationRateRadps * m.row(0);
  result.row(2).setZero();
  return result;
}

/// v x each column.
Eigen::Matrix3d cross_columns(const Eigen::Vector3d& v, const Eigen::Matrix3d& m) {
  Eigen::Matrix3d result;
  result.row(0) = v.y() * m.row(2) - v.z() * m.row(1);
  result.row(1) = v.z() * m.row(0) - v.x() * m.row(2);
  result.row(2) = v.x() * m.row(1) - v.y() * m.row(0);
  return result;
}

/// The step's own coefficients.
struct Motion {
  double half_dt_s;
  Eigen::Matrix3d gradient_dt_e;  // 1/s
  double coriolis;                // 2 omega_ie dt
};

/// Velocity and position rows of one column of blocks, by the midpoint rule.
/// @param push_v  what attitude and accelerometer error add to the velocity over the step
void advance_motion(Eigen::Matrix3d& v, Eigen::Matrix3d& r, const Eigen::Matrix3d& push_v,
                    const Motion& step) {
  const Eigen::Matrix3d r_mid = r + step.half_dt_s * v;
  const Eigen::Matrix3d v_pushed = v + push_v;
  // Coriolis by the mean of v before and after the push.
  const Eigen::RowVector3d turn_x = 0.5 * step.coriolis * (v.row(1) + v_pushed.row(1));
  const Eigen::RowVector3d turn_y = 0.5 * step.coriolis * (v.row(0) + v_pushed.row(0));
  v = v_pushed + step.gradient_dt_e.lazyProduct(r_mid);
  v.row(0) += turn_x;
  v.row(1) -= turn_y;
  r = r_mid + step.half_dt_s * v;
}

}  // namespace

double bias_decay(double dt_s, double tau_s) {
  return std::isinf(tau_s) ? 1.0 : std::exp(-dt_s / tau_s);
}

void advance(Transition& Phi, const ErrorDynamics& step) {
  const double dt_s = step.dt_s;
  const double a_a_end = Phi.a_a * step.a_a;
  const double g_g_end = Phi.g_g * step.g_g;
  const Eigen::Matrix3d C_dt = dt_s * step.C_eb_mean;

  const Eigen::Matrix3d psi_psi_old = Phi.psi_psi;
  const Eigen::Matrix3d psi_g_old = Phi.psi_g;
  Phi.psi_psi -= dt_s * earth_rate_cross(Phi.psi_psi);
  Phi.psi_g -= dt_s * earth_rate_cross(Phi.psi_g) + 0.5 * (Phi.g_g + g_g_end) * C_dt;

  const Motion motion{0.5 * dt_s, dt_s * step.gravity_gradient_e,
                      2.0 * dt_s * wgs84::kRotationRateRadps};
  const Eigen::Vector3d half_push = -0.5 * step.dv_f_e_mps;
  advance_motion(Phi.v_psi, Phi.r_psi, cross_columns(half_push, psi_psi_old + Phi.psi_psi), motion);
  advance_motion(Phi.v_g, Phi.r_g, cross_columns(half_push, psi_g_old + Phi.psi_g), motion);
  advance_motion(Phi.v_a, Phi.r_a, -0.5 * (Phi.a_a + a_a_end) * C_dt, motion);
  advance_motion(Phi.v_v, Phi.r_v, Eigen::Matrix3d::Zero(), motion);
  advance_motion(Phi.v_r, Phi.r_r, Eigen::Matrix3d::Zero(), motion);

  Phi.a_a = a_a_end;
  Phi.g_g = g_g_end;
  Phi.dt_s += dt_s;
}

Transition compose(const Transition& later, const Transition& earlier) {
  const Transition& l = later;
  const Transition& e = earlier;
  Transition Phi;
  Phi.dt_s = l.dt_s + e.dt_s;
  Phi.psi_psi = l.psi_psi * e.psi_psi;
  Phi.psi_g = l.psi_psi * e.psi_g + l.psi_g * e.g_g;
  Phi.v_psi = l.v_psi * e.psi_psi + l.v_v * e.v_psi + l.v_r * e.r_psi;
  Phi.v_v = l.v_v * e.v_v + l.v_r * e.r_v;
  Phi.v_r = l.v_v * e.v_r + l.v_r * e.r_r;
  Phi.v_a = l.v_v * e.v_a + l.v_r * e.r_a + l.v_a * e.a_a;
  Phi.v_g = l.v_psi * e.psi_g + l.v_v * e.v_g + l.v_r * e.r_g + l.v_g * e.g_g;
  Phi.r_psi = l.r_psi * e.psi_psi + l.r_v * e.v_psi + l.r_r * e.r_psi;
  Phi.r_v = l.r_v * e.v_v + l.r_r * e.r_v;
  Phi.r_r = l.r_v * e.v_r + l.r_r * e.r_r;
  Phi.r_a = l.r_v * e.v_a + l.r_r * e.r_a + l.r_a * e.a_a;
  Phi.r_g = l.r_psi * e.psi_g + l.r_v * e.v_g + l.r_r * e.r_g + l.r_g * e.g_g;
  Phi.a_a = l.a_a * e.a_a;
  Phi.g_g = l.g_g * e.g_g;
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
  M.block<3, 3>(kPsi, kPsi) = Phi.psi_psi;
  M.block<3, 3>(kPsi, kBg) = Phi.psi_g;
  M.block<3, 3>(kDv, kPsi) = Phi.v_psi;
  M.block<3, 3>(kDv, kDv) = Phi.v_v;
  M.block<3, 3>(kDv, kDr) = Phi.v_r;
  M.block<3, 3>(kDv, kBa) = Phi.v_a;
  M.block<3, 3>(kDv, kBg) = Phi.v_g;
  M.block<3, 3>(kDr, kPsi) = Phi.r_psi;
  M.block<3, 3>(kDr, kDv) = Phi.r_v;
  M.block<3, 3>(kDr, kDr) = Phi.r_r;
  M.block<3, 3>(kDr, kBa) = Phi.r_a;
  M.block<3, 3>(kDr, kBg) = Phi.r_g;
  M.block<3, 3>(kBa, kBa).diagonal().setConstant(Phi.a_a);
  M.block<3, 3>(kBg, kBg).diagonal().setConstant(Phi.g_g);
  return M;
}

}  // namespace leeway
