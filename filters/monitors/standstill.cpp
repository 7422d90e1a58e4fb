#include "leeway/monitors/standstill.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway {
namespace {

// Beyond a fast walk an unknown speed is no sign of rest: a smooth road is as quiet.
constexpr double kLargestSlackMps = 3.0;

double spread(const Eigen::Vector3d& sum, const Eigen::Vector3d& square_sum, int count) {
  const Eigen::Vector3d mean = sum / count;
  return std::sqrt((square_sum / count - mean.cwiseAbs2()).cwiseMax(0.0).sum());
}

Eigen::Vector3d mean_acceleration_e(const ImuBlock& block, const Estimate& estimate) {
  return estimate.nav.q_eb * (block.mean_f_ib_b_mps2 - estimate.bias.b_a_mps2) +
         gravity_e(GravityModel::kNormal, estimate.nav.r_e_m);
}

}  // namespace

std::optional<ImuBlock> ImuBlocks::push(const ImuIncrement& inc) {
  const Eigen::Vector3d omega = inc.dtheta_b_rad / inc.dt_s;
  const Eigen::Vector3d f = inc.dv_b_mps / inc.dt_s;
  dt_s_ += inc.dt_s;
  ++count_;
  omega_sum_ += omega;
  omega_square_sum_ += omega.cwiseAbs2();
  f_sum_ += f;
  f_square_sum_ += f.cwiseAbs2();
  if (dt_s_ + 0.5 * inc.dt_s < kBlockS) return std::nullopt;
  ImuBlock block;
  block.time = inc.time;
  block.dt_s = dt_s_;
  block.mean_omega_ib_b_radps = omega_sum_ / count_;
  block.mean_f_ib_b_mps2 = f_sum_ / count_;
  block.gyro_std_radps = spread(omega_sum_, omega_square_sum_, count_);
  block.force_std_mps2 = spread(f_sum_, f_square_sum_, count_);
  block.count = count_;
  *this = ImuBlocks{};
  return block;
}

StandstillDetector::StandstillDetector(const StandstillConfig& config, const ImuErrorModel& imu)
    : config_(config),
      gyro_noise_rad_per_sqrt_s_(imu.gyro.noise_density),
      force_noise_mps_per_sqrt_s_(imu.accelerometer.noise_density) {
  validate_fields("standstill", config);
}

bool StandstillDetector::push(const ImuBlock& block, const Ekf& filter) {
  const bool still = looks_still(block, filter);
  const bool at_rest = still && was_still_;
  was_still_ = still;
  return at_rest;
}

bool StandstillDetector::is_even(const ImuBlock& block, const Ekf& filter) const {
  constexpr double kEvenSigmas = 3.0;
  const auto& [nav, bias] = filter.estimate();
  const ErrorMatrix& P = filter.kernel().matrix();
  const Eigen::Matrix3d C_eb = nav.q_eb.toRotationMatrix();
  Eigen::Matrix<double, 3, 6> H;
  H << -skew(nav.q_eb * block.mean_f_ib_b_mps2), -C_eb;
  Eigen::Matrix<double, 6, 6> P_H;
  P_H << P.block<3, 3>(kPsi, kPsi), P.block<3, 3>(kPsi, kBa), P.block<3, 3>(kBa, kPsi),
      P.block<3, 3>(kBa, kBa);
  const Eigen::Matrix3d P_a = H * P_H * H.transpose();
  const Eigen::Vector3d down_e = down_e_at(nav.r_e_m);
  const Eigen::Vector3d a_e = mean_acceleration_e(block, filter.estimate());
  const double horizontal2 = a_e.squaredNorm() - std::pow(down_e.dot(a_e), 2);
  const double variance = P_a.trace() - down_e.dot(P_a * down_e) +
                          2.0 * std::pow(force_noise_mps_per_sqrt_s_, 2) / block.dt_s;
  return horizontal2 < kEvenSigmas * kEvenSigmas * variance;
}

bool StandstillDetector::looks_still(const ImuBlock& block, const Ekf& filter) const {
  // Three axes of white noise at the rate of the samples, and half as much again.
  const double from_noise = 1.5 * std::sqrt(3.0 * block.count / block.dt_s);
  const double gyro_limit =
      std::max(config_.gyro_std_radps, from_noise * gyro_noise_rad_per_sqrt_s_);
  const double force_limit =
      std::max(config_.force_std_mps2, from_noise * force_noise_mps_per_sqrt_s_);
  if (block.gyro_std_radps > gyro_limit || block.force_std_mps2 > force_limit) return false;

  const ErrorMatrix P = filter.covariance();
  const auto sigma = [&P](int i) { return std::sqrt(P.diagonal().segment<3>(i).sum()); };
  const double mean_noise = gyro_noise_rad_per_sqrt_s_ / std::sqrt(block.dt_s);
  const double turn_limit = config_.turn_radps + 3.0 * std::hypot(sigma(kBg), mean_noise);
  const Eigen::Vector3d rate = block.mean_omega_ib_b_radps - filter.estimate().bias.b_g_radps;
  const Eigen::Vector3d a_e = mean_acceleration_e(block, filter.estimate());
  const double tilt_as_force = kStandardGravityMps2 * sigma(kPsi);
  const double force_noise = force_noise_mps_per_sqrt_s_ / std::sqrt(block.dt_s);
  const double acceleration_limit =
      config_.acceleration_mps2 + 2.0 * std::hypot(tilt_as_force, sigma(kBa), force_noise);
  return rate.norm() < turn_limit && a_e.norm() < acceleration_limit &&
         filter.estimate().nav.v_e_mps.norm() <
             config_.speed_mps + std::min(3.0 * sigma(kDv), kLargestSlackMps);
}

}  // namespace leeway
