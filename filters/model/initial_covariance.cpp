#include "leeway/model/initial_covariance.hpp"

#include "leeway/earth/earth.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {

ErrorMatrix initial_covariance(const Estimate& estimate, const InitialSigma& sigma,
                               const ImuErrorModel& imu, const BiasStates& biases) {
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(estimate.nav.r_e_m));
  const Eigen::Vector3d psi_n(sigma.tilt_rad, sigma.tilt_rad, sigma.heading_rad);
  const auto variance = [](const TriadErrorModel& triad, BiasState state) {
    if (state == BiasState::kNone) return 0.0;
    return triad.bias_sigma * triad.bias_sigma + triad.in_run.sigma * triad.in_run.sigma;
  };
  ErrorMatrix P = ErrorMatrix::Zero();
  P.block<3, 3>(kPsi, kPsi) = C_en * psi_n.cwiseAbs2().asDiagonal() * C_en.transpose();
  P.diagonal().segment<3>(kDv).setConstant(sigma.velocity_mps * sigma.velocity_mps);
  P.diagonal().segment<3>(kDr).setConstant(sigma.position_m * sigma.position_m);
  P.diagonal().segment<3>(kBa).setConstant(variance(imu.accelerometer, biases.accelerometer));
  P.diagonal().segment<3>(kBg).setConstant(variance(imu.gyro, biases.gyro));
  return P;
}

}  // namespace leeway
