#include "leeway/covariance/covariance.hpp"

#include <cmath>
#include <limits>

#include "filters/covariance/measurement_update.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"

namespace leeway {
namespace {

template <int N>
double scalar_update_of(Eigen::Matrix<double, N, N>& P, Eigen::Matrix<double, N, 1>& x_hat,
                        const Eigen::Matrix<double, N, 1>& h, double z) {
  Eigen::Matrix<double, N, 1> K;
  const double variance = update_by_row<double, N>(P, K, h, UpdateForm::kJoseph);
  x_hat += K * (z - h.dot(x_hat));
  return variance;
}

struct BiasDrive {
  double density;
  double tau_s;
};

BiasDrive bias_drive(const TriadErrorModel& triad, BiasState state) {
  const double infinity = std::numeric_limits<double>::infinity();
  const GaussMarkov& in_run = triad.in_run;
  const bool is_driven = state == BiasState::kModelled || state == BiasState::kRandomWalk;
  if (!is_driven || in_run.sigma == 0.0 || std::isinf(in_run.tau_s)) return {0.0, infinity};
  const double density = 2.0 * in_run.sigma * in_run.sigma / in_run.tau_s;
  const bool decays = state == BiasState::kModelled && triad.bias_sigma == 0.0;
  return {density, decays ? in_run.tau_s : infinity};
}

}  // namespace

ProcessNoise process_noise(const ImuErrorModel& model, const BiasStates& biases) {
  validate(model);
  const BiasDrive a = bias_drive(model.accelerometer, biases.accelerometer);
  const BiasDrive g = bias_drive(model.gyro, biases.gyro);
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
  propagate_symmetric<double, kErrorStates>(P, Phi, noise);
}

void propagate(ErrorMatrix& P, const ErrorDynamics& step, const ProcessNoise& noise) {
  propagate_symmetric<double, kErrorStates>(P, step, noise);
}

void transform_block(ErrorMatrix& P, int row, const Eigen::Matrix3d& T) {
  P.middleRows<3>(row) = (T * P.middleRows<3>(row)).eval();
  P.middleCols<3>(row) = (P.middleCols<3>(row) * T.transpose()).eval();
}

double scalar_update(ErrorMatrix& P, ErrorVector& x_hat, const ErrorVector& h, double z) {
  return scalar_update_of<kErrorStates>(P, x_hat, h, z);
}

double scalar_update(JointMatrix& P, JointVector& x_hat, const JointVector& h, double z) {
  return scalar_update_of<kJointStates>(P, x_hat, h, z);
}

}  // namespace leeway
