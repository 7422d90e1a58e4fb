#include "filters/ekf/error_growth.hpp"

#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {
namespace {

/// The Earth's rotation in the axes l of a time from now, rad/s.
Eigen::Vector3d earth_rate(const SteadyMotion& motion, double t_s) {
  const Eigen::Vector3d rate_e = earth_rotation_e_radps();
  const Eigen::Vector3d vertical = rate_e.dot(motion.down_e) * motion.down_e;
  const Eigen::Vector3d north = rate_e - vertical;
  const double angle = motion.turn_radps * t_s;
  return vertical + std::cos(angle) * north - std::sin(angle) * motion.down_e.cross(north);
}

}  // namespace

SteadyMotion steady_motion(const Ekf& filter) {
  const auto& [nav, bias] = filter.estimate();
  const Eigen::Vector3d omega_ie = earth_rotation_e_radps();
  SteadyMotion motion;
  motion.v_e_mps = nav.v_e_mps;
  motion.down_e = down_e_at(nav.r_e_m);
  motion.C_eb = nav.q_eb.toRotationMatrix();
  motion.gravity_gradient_e = gravity_gradient_e(nav.r_e_m);
  const Eigen::Vector3d omega_ib_b = filter.inertial().mean_omega_ib_b_radps() - bias.b_g_radps;
  motion.turn_radps = motion.down_e.dot(motion.C_eb * omega_ib_b - omega_ie);
  motion.omega_el_radps =
      nav.r_e_m.cross(nav.v_e_mps) / nav.r_e_m.squaredNorm() + motion.turn_radps * motion.down_e;
  motion.f_mps2 = (motion.omega_el_radps + 2.0 * omega_ie).cross(nav.v_e_mps) -
                  gravity_e<GravityModel::kNormal>(nav.r_e_m);
  motion.noise = filter.inertial().noise();
  return motion;
}

Coasting first_step(const SteadyMotion& motion, double dt_s) {
  const Eigen::Vector3d turn_rad = dt_s * motion.omega_el_radps;
  const Eigen::Matrix3d C_mean = left_jacobian(turn_rad);
  ErrorDynamics dynamics;
  dynamics.dt_s = dt_s;
  dynamics.C_eb_mean = C_mean * motion.C_eb;
  dynamics.dv_f_e_mps = dt_s * (C_mean * motion.f_mps2);
  dynamics.gravity_gradient_e = motion.gravity_gradient_e;
  dynamics.a_a = bias_decay(dt_s, motion.noise.tau_a_s);
  dynamics.g_g = bias_decay(dt_s, motion.noise.tau_g_s);
  Coasting step;
  Transition& Phi = step.Phi;
  advance(Phi, dynamics);
  const Eigen::Matrix3d C_le = exp_rotation(-turn_rad);
  for (Transition::Rows* rows : {&Phi.psi, &Phi.v, &Phi.r}) *rows = C_le * (*rows).eval();
  propagate(step.Q, Phi, motion.noise);
  return step;
}

Coasting started_later(const Coasting& next, const SteadyMotion& motion, double start_s) {
  const double dt_s = next.Phi.dt_s;
  const auto half_more_rad = [&](double t_s) -> Eigen::Vector3d {
    return 0.5 * dt_s * (earth_rate(motion, start_s + t_s) - earth_rate(motion, t_s));
  };
  const Eigen::Vector3d first_rad = half_more_rad(0.0);
  const Eigen::Vector3d last_rad = half_more_rad(dt_s);
  Coasting result = next;
  if (first_rad.squaredNorm() < 1e-20) return result;
  const Eigen::Matrix3d first = exp_rotation(-first_rad);
  const Eigen::Matrix3d last = exp_rotation(-last_rad);
  const Eigen::Matrix3d first_v = first * first;  // Coriolis: twice the rate
  const Eigen::Matrix3d last_v = last * last;
  Transition& Phi = result.Phi;
  const auto turn_columns = [](Transition::Rows& rows, int of, const Eigen::Matrix3d& turn) {
    rows.middleCols<3>(of) = (rows.middleCols<3>(of) * turn).eval();
  };
  Phi.psi = last * Phi.psi.eval();
  turn_columns(Phi.psi, kPsi, first);
  Phi.v = last_v * Phi.v.eval();
  turn_columns(Phi.v, kPsi, first);
  turn_columns(Phi.v, kDv, first_v);
  // What turns at a steady rate through the step moves r, which grows with the square of the time
  // left, by a third, where all of it at the start would move it by one: not by a half.
  turn_columns(Phi.r, kPsi, exp_rotation(-2.0 / 3.0 * first_rad));
  turn_columns(Phi.r, kDv, first_v);
  return result;
}

Coasting compose(const Coasting& later, const Coasting& earlier) {
  Coasting both;
  both.Phi = compose(later.Phi, earlier.Phi);
  both.Q = earlier.Q;
  apply(later, both.Q);
  return both;
}

void apply(const Coasting& step, ErrorMatrix& P) {
  propagate(P, step.Phi, ProcessNoise{});
  P += step.Q;
}

}  // namespace leeway
