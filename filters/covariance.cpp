#include "leeway/filters/covariance.hpp"

#include <cmath>
#include <limits>

namespace leeway {
namespace {

using Rows = Eigen::Matrix<double, 3, kErrorStates>;

void add_noise(ErrorMatrix& P, const ProcessNoise& noise, double dt_s) {
  P.diagonal().segment<3>(kPsi).array() += noise.attitude_rad2_per_s * dt_s;
  P.diagonal().segment<3>(kDv).array() += noise.velocity_m2_per_s3 * dt_s;
  P.diagonal().segment<3>(kBa).array() += noise.b_a_m2_per_s5 * dt_s;
  P.diagonal().segment<3>(kBg).array() += noise.b_g_rad2_per_s3 * dt_s;
}

void mirror_upper(ErrorMatrix& P) {
  for (int j = 0; j < kErrorStates; ++j) {
    for (int i = j + 1; i < kErrorStates; ++i) P(i, j) = P(j, i);
  }
}

struct BiasDrive {
  double density;
  double tau_s;
};

BiasDrive bias_drive(const TriadErrorModel& triad) {
  const double infinity = std::numeric_limits<double>::infinity();
  const GaussMarkov& in_run = triad.in_run;
  if (in_run.sigma == 0.0 || std::isinf(in_run.tau_s)) return {0.0, infinity};
  const double density = 2.0 * in_run.sigma * in_run.sigma / in_run.tau_s;
  return {density, triad.bias_sigma > 0.0 ? infinity : in_run.tau_s};
}

}  // namespace

ProcessNoise process_noise(const ImuErrorModel& model) {
  validate(model);
  const BiasDrive a = bias_drive(model.accelerometer);
  const BiasDrive g = bias_drive(model.gyro);
  ProcessNoise noise;
  noise.attitude_rad2_per_s = model.gyro.noise_density * model.gyro.noise_density;
  noise.velocity_m2_per_s3 = model.accelerometer.noise_density * model.accelerometer.noise_density;
  noise.b_a_m2_per_s5 = a.density;
  noise.b_g_rad2_per_s3 = g.density;
  noise.tau_a_s = a.tau_s;
  noise.tau_g_s = g.tau_s;
  return noise;
}

void propagate(ErrorMatrix& P, const Transition& Phi, const ProcessNoise& noise) {
  add_noise(P, noise, 0.5 * Phi.dt_s);

  // W = Phi P, row block by row block; the bias rows only scale.
  const auto rows = [&P](int i) { return P.middleRows<3>(i); };
  const Rows W_psi = Phi.psi_psi * rows(kPsi) + Phi.psi_g * rows(kBg);
  const Rows W_v = Phi.v_psi * rows(kPsi) + Phi.v_v * rows(kDv) + Phi.v_r * rows(kDr) +
                   Phi.v_a * rows(kBa) + Phi.v_g * rows(kBg);
  const Rows W_r = Phi.r_psi * rows(kPsi) + Phi.r_v * rows(kDv) + Phi.r_r * rows(kDr) +
                   Phi.r_a * rows(kBa) + Phi.r_g * rows(kBg);

  // P = W Phi^T, the upper blocks only.
  const auto times_psi = [&Phi](const Rows& W) -> Eigen::Matrix3d {
    return W.middleCols<3>(kPsi) * Phi.psi_psi.transpose() +
           W.middleCols<3>(kBg) * Phi.psi_g.transpose();
  };
  const auto times_v = [&Phi](const Rows& W) -> Eigen::Matrix3d {
    return W.middleCols<3>(kPsi) * Phi.v_psi.transpose() +
           W.middleCols<3>(kDv) * Phi.v_v.transpose() + W.middleCols<3>(kDr) * Phi.v_r.transpose() +
           W.middleCols<3>(kBa) * Phi.v_a.transpose() + W.middleCols<3>(kBg) * Phi.v_g.transpose();
  };
  const auto times_r = [&Phi](const Rows& W) -> Eigen::Matrix3d {
    return W.middleCols<3>(kPsi) * Phi.r_psi.transpose() +
           W.middleCols<3>(kDv) * Phi.r_v.transpose() + W.middleCols<3>(kDr) * Phi.r_r.transpose() +
           W.middleCols<3>(kBa) * Phi.r_a.transpose() + W.middleCols<3>(kBg) * Phi.r_g.transpose();
  };
  P.block<3, 3>(kPsi, kPsi) = times_psi(W_psi);
  P.block<3, 3>(kPsi, kDv) = times_v(W_psi);
  P.block<3, 3>(kPsi, kDr) = times_r(W_psi);
  P.block<3, 3>(kDv, kDv) = times_v(W_v);
  P.block<3, 3>(kDv, kDr) = times_r(W_v);
  P.block<3, 3>(kDr, kDr) = times_r(W_r);
  const auto set_bias_columns = [&P, &Phi](int row, const Rows& W) {
    P.block<3, 3>(row, kBa) = Phi.a_a * W.middleCols<3>(kBa);
    P.block<3, 3>(row, kBg) = Phi.g_g * W.middleCols<3>(kBg);
  };
  set_bias_columns(kPsi, W_psi);
  set_bias_columns(kDv, W_v);
  set_bias_columns(kDr, W_r);
  P.block<3, 3>(kBa, kBa) *= Phi.a_a * Phi.a_a;
  P.block<3, 3>(kBa, kBg) *= Phi.a_a * Phi.g_g;
  P.block<3, 3>(kBg, kBg) *= Phi.g_g * Phi.g_g;
  mirror_upper(P);

  add_noise(P, noise, 0.5 * Phi.dt_s);
}

double scalar_update(ErrorMatrix& P, ErrorVector& x_hat, const ErrorVector& h, double z) {
  const ErrorVector u = P * h;
  const double s = h.dot(u) + 1.0;
  const ErrorVector K = u / s;
  // A h is formed from the rounded A: that is what keeps P positive definite where the expanded
  // form, in which it cancels against K, does not.
  const ErrorMatrix A = P - K * u.transpose();
  const ErrorVector residue = A * h - K;
  P = A - residue * K.transpose();
  mirror_upper(P);
  x_hat += K * (z - h.dot(x_hat));
  return s;
}

}  // namespace leeway
