#include "sim/analysis/truth_model.hpp"

namespace leeway::sim {
namespace {

Eigen::Matrix3d off_diagonal(double value) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Constant(value);
  m.diagonal().setZero();
  return m;
}

}  // namespace

ParameterMoments parameter_moments(const ImuErrorModel& imu) {
  ParameterMoments moments;
  const auto add = [&](ErrorSource source, int first, const Eigen::Matrix3d& known,
                       const Eigen::Matrix3d& sigma) {
    if (known.isZero(0.0) && sigma.isZero(0.0)) return;
    const Eigen::Matrix<double, 9, 1> mean = known.reshaped();
    ParameterMoment moment = ParameterMoment::Zero();
    moment.block<9, 9>(first, first) = mean * mean.transpose();
    moment.block<9, 9>(first, first).diagonal() += sigma.reshaped().cwiseAbs2();
    moments.emplace_back(source, moment);
  };
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const auto add_triad = [&](const TriadErrorModel& triad, int first, ErrorSource scale,
                             ErrorSource misalignment) {
    const Eigen::Matrix3d known = triad.M - I;
    const Eigen::Matrix3d known_scale = known.diagonal().asDiagonal();
    add(scale, first, known_scale, triad.scale_sigma * I);
    add(misalignment, first, known - known_scale, off_diagonal(triad.misalignment_sigma_rad));
  };
  add_triad(imu.accelerometer, kMa, ErrorSource::kAccelerometerScale,
            ErrorSource::kAccelerometerMisalignment);
  add_triad(imu.gyro, kMg, ErrorSource::kGyroScale, ErrorSource::kGyroMisalignment);
  add(ErrorSource::kGyroGSensitivity, kGg, imu.G_g_radps_per_mps2,
      Eigen::Matrix3d::Constant(imu.G_g_sigma_radps_per_mps2));
  return moments;
}

}  // namespace leeway::sim
