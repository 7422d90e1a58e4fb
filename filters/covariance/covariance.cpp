#include "leeway/covariance/covariance.hpp"

#include "filters/covariance/cholesky.hpp"
#include "filters/covariance/measurement_update.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/model/process_noise.hpp"

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

}  // namespace

void propagate(ErrorMatrix& P, const Transition& Phi, const ProcessNoise& noise) {
  propagate_symmetric<double, kErrorStates>(P, Phi, noise);
}

void propagate(ErrorMatrix& P, const ErrorDynamics& step, const ProcessNoise& noise) {
  propagate_symmetric<double, kErrorStates>(P, step, noise);
}

void propagate(VehicleState& vehicle, const Transition& Phi) {
  vehicle.cross = times(Phi, vehicle.cross);
  vehicle.P.diagonal() += Phi.dt_s * vehicle.random_walk_per_s;
}

void transform_block(ErrorMatrix& P, int row, const Eigen::Matrix3d& T) {
  P.middleRows<3>(row) = (T * P.middleRows<3>(row)).eval();
  P.middleCols<3>(row) = (P.middleCols<3>(row) * T.transpose()).eval();
}

bool is_positive_definite(const ErrorMatrix& P) { return Cholesky<kErrorStates>(P).positive(); }

double scalar_update(ErrorMatrix& P, ErrorVector& x_hat, const ErrorVector& h, double z) {
  return scalar_update_of<kErrorStates>(P, x_hat, h, z);
}

double scalar_update(JointMatrix& P, JointVector& x_hat, const JointVector& h, double z) {
  return scalar_update_of<kJointStates>(P, x_hat, h, z);
}

}  // namespace leeway
