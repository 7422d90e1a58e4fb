#include "leeway/filters/covariance.hpp"

#include <cmath>
#include <limits>

namespace leeway {
namespace {

using AttitudeRows = Eigen::Matrix<double, 3, kErrorStates>;
using MotionRows = Eigen::Matrix<double, 6, kErrorStates>;  // of velocity and position

MotionRows motion_rows(const Transition& Phi) {
  MotionRows M;
  M << Phi.v_psi, Phi.v_v, Phi.v_r, Phi.v_a, Phi.v_g,  //
      Phi.r_psi, Phi.r_v, Phi.r_r, Phi.r_a, Phi.r_g;
  return M;
}

/// The sum of the columns with these weights: a product in the order in which six rows are three
/// pairs, which halves its instructions.
template <class Weights>
Eigen::Matrix<double, 6, 1> combined_columns(const MotionRows& m, const Weights& weights) {
  Eigen::Matrix<double, 6, 1> sum = weights[0] * m.col(0);
  for (int k = 1; k < kErrorStates; ++k) sum += weights[k] * m.col(k);
  return sum;
}

void add_noise(ErrorMatrix& P, const ProcessNoise& noise, double dt_s) {
  P.diagonal().segment<3>(kPsi).array() += noise.attitude_rad2_per_s * dt_s;
  P.diagonal().segment<3>(kDv).array() += noise.velocity_m2_per_s3 * dt_s;
  P.diagonal().segment<3>(kBa).array() += noise.b_a_m2_per_s5 * dt_s;
  P.diagonal().segment<3>(kBg).array() += noise.b_g_rad2_per_s3 * dt_s;
}

template <int N>
void mirror_upper(Eigen::Matrix<double, N, N>& P) {
  for (int j = 0; j < N; ++j) {
    for (int i = j + 1; i < N; ++i) P(i, j) = P(j, i);
  }
}

template <int N>
double scalar_update_of(Eigen::Matrix<double, N, N>& P, Eigen::Matrix<double, N, 1>& x_hat,
                        const Eigen::Matrix<double, N, 1>& h, double z) {
  const Eigen::Matrix<double, N, 1> u = P * h;
  const double s = h.dot(u) + 1.0;
  const Eigen::Matrix<double, N, 1> K = u / s;
  // A h is formed from the rounded A: that is what keeps P positive definite where the expanded
  // form, in which it cancels against K, does not.
  const Eigen::Matrix<double, N, N> A = P - K * u.transpose();
  const Eigen::Matrix<double, N, 1> residue = A * h - K;
  P = A - residue * K.transpose();
  mirror_upper(P);
  x_hat += K * (z - h.dot(x_hat));
  return s;
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

  // W = Phi P without the bias rows, which only scale.
  const AttitudeRows W_psi = Phi.psi_psi * P.middleRows<3>(kPsi) + Phi.psi_g * P.middleRows<3>(kBg);
  const MotionRows M = motion_rows(Phi);
  MotionRows W;
  for (int j = 0; j < kErrorStates; ++j) W.col(j) = combined_columns(M, P.col(j));

  // P = W Phi^T, the upper blocks.
  P.block<3, 3>(kPsi, kPsi) = W_psi.middleCols<3>(kPsi) * Phi.psi_psi.transpose() +
                              W_psi.middleCols<3>(kBg) * Phi.psi_g.transpose();
  for (int i = 0; i < M.rows(); ++i) {
    P.block<3, 1>(kPsi, kDv + i) = W_psi * M.row(i).transpose();
    P.block<6, 1>(kDv, kDv + i) = combined_columns(W, M.row(i));
  }
  P.block<3, 3>(kPsi, kBa) = Phi.a_a * W_psi.middleCols<3>(kBa);
  P.block<3, 3>(kPsi, kBg) = Phi.g_g * W_psi.middleCols<3>(kBg);
  P.block<6, 3>(kDv, kBa) = Phi.a_a * W.middleCols<3>(kBa);
  P.block<6, 3>(kDv, kBg) = Phi.g_g * W.middleCols<3>(kBg);
  P.block<3, 3>(kBa, kBa) *= Phi.a_a * Phi.a_a;
  P.block<3, 3>(kBa, kBg) *= Phi.a_a * Phi.g_g;
  P.block<3, 3>(kBg, kBg) *= Phi.g_g * Phi.g_g;
  mirror_upper(P);

  add_noise(P, noise, 0.5 * Phi.dt_s);
}

void transform_block(ErrorMatrix& P, int row, const Eigen::Matrix3d& T) {
  P.middleRows<3>(row) = (T * P.middleRows<3>(row)).eval();
  P.middleCols<3>(row) = (P.middleCols<3>(row) * T.transpose()).eval();
}

VehicleCross transported(const Transition& Phi, const VehicleCross& C) {
  VehicleCross result;
  result.middleRows<3>(kPsi) =
      Phi.psi_psi * C.middleRows<3>(kPsi) + Phi.psi_g * C.middleRows<3>(kBg);
  result.middleRows<6>(kDv) = motion_rows(Phi) * C;
  result.middleRows<3>(kBa) = Phi.a_a * C.middleRows<3>(kBa);
  result.middleRows<3>(kBg) = Phi.g_g * C.middleRows<3>(kBg);
  return result;
}

double scalar_update(ErrorMatrix& P, ErrorVector& x_hat, const ErrorVector& h, double z) {
  return scalar_update_of<kErrorStates>(P, x_hat, h, z);
}

double scalar_update(JointMatrix& P, JointVector& x_hat, const JointVector& h, double z) {
  return scalar_update_of<kJointStates>(P, x_hat, h, z);
}

}  // namespace leeway
