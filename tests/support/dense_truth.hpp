/// @file
/// The truth model of a scene as one dense covariance of 51 states, written down from the
/// differential equations and integrated in small steps: slow and independent of the library's
/// split by source.
#pragma once

#include <Eigen/Dense>
#include <cmath>

#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::test {

/// States: filter error (15), M_a, M_g, G_g column by column (27), in-run biases of accelerometer
/// and gyro (3 + 3), correlated position error of the receiver in north-east-down (3).
class DenseTruth {
 public:
  static constexpr int kStates = 51;
  static constexpr int kParameters = 15;
  static constexpr int kInRunA = 42;
  static constexpr int kInRunG = 45;
  static constexpr int kReceiver = 48;
  using Matrix = Eigen::Matrix<double, kStates, kStates>;

  DenseTruth(const sim::Scene& scene, const ErrorMatrix& filter_P)
      : scene_(scene), filter_P_(filter_P) {
    P_.topLeftCorner<15, 15>() = filter_P;
    const ImuErrorModel& imu = scene.imu;
    set_triad(imu.accelerometer, kParameters, kBa, kInRunA);
    set_triad(imu.gyro, kParameters + 9, kBg, kInRunG);
    P_.diagonal()
        .segment<9>(kParameters + 18)
        .setConstant(std::pow(imu.G_g_sigma_radps_per_mps2, 2));
    P_.diagonal().segment<3>(kReceiver) = scene.gnss.errors.correlated_sigma_n_m.cwiseAbs2();
  }

  /// Both covariances over dt_s, by the second-order expansion of the dense transition.
  void propagate(double t_s, double dt_s) {
    const sim::TruthPoint truth = sim::truth_at(scene_.trajectory, t_s + 0.5 * dt_s);
    const ProcessNoise noise = process_noise(scene_.filter.imu);
    const Eigen::Matrix3d C = truth.nav.q_eb.toRotationMatrix();
    const ErrorMatrix F15 =
        system_matrix(C, C * truth.f_ib_b_mps2, gravity_gradient_e(truth.nav.r_e_m), noise.tau_a_s,
                      noise.tau_g_s);
    Matrix F = Matrix::Zero();
    F.topLeftCorner<15, 15>() = F15;
    for (int j = 0; j < 3; ++j) {
      F.block<3, 3>(kDv, kParameters + 3 * j) = -C * truth.f_ib_b_mps2(j);
      F.block<3, 3>(kPsi, kParameters + 9 + 3 * j) = -C * truth.omega_ib_b_radps(j);
      F.block<3, 3>(kPsi, kParameters + 18 + 3 * j) = -C * truth.f_ib_b_mps2(j);
    }
    Matrix Q = Matrix::Zero();
    Eigen::Matrix<double, 15, 15> Q15 = Eigen::Matrix<double, 15, 15>::Zero();
    Q15.diagonal().segment<3>(kPsi).setConstant(noise.attitude_rad2_per_s);
    Q15.diagonal().segment<3>(kDv).setConstant(noise.velocity_m2_per_s3);
    Q.topLeftCorner<15, 15>() = Q15;
    Q15.diagonal().segment<3>(kBa).setConstant(noise.b_a_m2_per_s5);
    Q15.diagonal().segment<3>(kBg).setConstant(noise.b_g_rad2_per_s3);
    add_in_run(scene_.imu.accelerometer.in_run, noise.tau_a_s, kBa, kInRunA, F, Q);
    add_in_run(scene_.imu.gyro.in_run, noise.tau_g_s, kBg, kInRunG, F, Q);
    F.block<3, 3>(kReceiver, kReceiver)
        .diagonal()
        .setConstant(-1.0 / scene_.gnss.errors.correlation_time_s);
    const Eigen::Vector3d receiver_drive = 2.0 / scene_.gnss.errors.correlation_time_s *
                                           scene_.gnss.errors.correlated_sigma_n_m.cwiseAbs2();
    Q.diagonal().segment<3>(kReceiver) = receiver_drive;
    const Matrix Phi = Matrix::Identity() + dt_s * F + 0.5 * dt_s * dt_s * F * F;
    P_ = Phi * (P_ + 0.5 * dt_s * Q) * Phi.transpose() + 0.5 * dt_s * Q;
    const ErrorMatrix Phi15 = ErrorMatrix::Identity() + dt_s * F15 + 0.5 * dt_s * dt_s * F15 * F15;
    filter_P_ = Phi15 * (filter_P_ + 0.5 * dt_s * Q15) * Phi15.transpose() + 0.5 * dt_s * Q15;
  }

  /// The filter's batch gain, applied to both.
  void update(double t_s) {
    const sim::TruthPoint truth = sim::truth_at(scene_.trajectory, t_s);
    Estimate estimate;
    estimate.nav = truth.nav;
    const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(truth.nav.r_e_m)).transpose();
    const GnssFix fix{truth.nav.time, GnssPosition{}, GnssVelocity{}};
    Eigen::Matrix<double, 6, 15> H =
        gnss_measurement(fix, estimate, scene_.filter.lever_arm_b_m, truth.omega_ib_b_radps).H;
    H.topRows<3>() = (C_ne * H.topRows<3>()).eval();
    H.bottomRows<3>() = (C_ne * H.bottomRows<3>()).eval();
    const sim::GnssErrorModel& gnss = scene_.gnss.errors;
    Eigen::Matrix<double, 6, 6> R_filter = Eigen::Matrix<double, 6, 6>::Zero();
    R_filter.diagonal().head<3>() =
        gnss.position_sigma_n_m.cwiseAbs2() + gnss.correlated_sigma_n_m.cwiseAbs2();
    R_filter.diagonal().tail<3>() = gnss.velocity_sigma_n_mps.cwiseAbs2();
    if (last_fix_s_ > 0.0 && scene_.filter.gnss_correlation_s > 0.0) {
      const double a = std::exp(-(t_s - last_fix_s_) / scene_.filter.gnss_correlation_s);
      R_filter.diagonal().head<3>() *= (1.0 + a) / (1.0 - a);
    }
    last_fix_s_ = t_s;
    Eigen::Matrix<double, 6, 6> R_white = Eigen::Matrix<double, 6, 6>::Zero();
    R_white.diagonal().head<3>() = gnss.position_sigma_n_m.cwiseAbs2();
    R_white.diagonal().tail<3>() = gnss.velocity_sigma_n_mps.cwiseAbs2();

    const Eigen::Matrix<double, 15, 6> K =
        filter_P_ * H.transpose() * (H * filter_P_ * H.transpose() + R_filter).inverse();
    const ErrorMatrix I_KH = ErrorMatrix::Identity() - K * H;
    filter_P_ = I_KH * filter_P_ * I_KH.transpose() + K * R_filter * K.transpose();
    Matrix A = Matrix::Identity();
    A.topLeftCorner<15, 15>() = I_KH;
    A.block<15, 3>(0, kReceiver) = -K.leftCols<3>();
    P_ = A * P_ * A.transpose();
    P_.topLeftCorner<15, 15>() += K * R_white * K.transpose();
  }

  ErrorMatrix claimed() const { return filter_P_; }
  ErrorMatrix truth() const { return P_.topLeftCorner<15, 15>(); }

 private:
  void set_triad(const TriadErrorModel& triad, int parameters, int bias, int in_run) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        const double sigma = i == j ? triad.scale_sigma : triad.misalignment_sigma_rad;
        P_(parameters + 3 * j + i, parameters + 3 * j + i) = sigma * sigma;
      }
    }
    const double variance = triad.in_run.sigma * triad.in_run.sigma;
    const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
    P_.block<3, 3>(bias, bias) = (triad.bias_sigma * triad.bias_sigma + variance) * I;
    P_.block<3, 3>(in_run, in_run) = variance * I;
    P_.block<3, 3>(bias, in_run) = variance * I;
    P_.block<3, 3>(in_run, bias) = variance * I;
  }

  /// g' = -g / tau + w. The error of the filter's bias, c + g - b_hat with b_hat' = -b_hat /
  /// filter_tau, follows: e' = -e / filter_tau + c / filter_tau + g (1 / filter_tau - 1 / tau) + w.
  /// These scenes have c only where filter_tau is infinite.
  static void add_in_run(const GaussMarkov& in_run, double filter_tau_s, int bias, int row,
                         Matrix& F, Matrix& Q) {
    const double drive = 2.0 * in_run.sigma * in_run.sigma / in_run.tau_s;
    F.block<3, 3>(row, row).diagonal().setConstant(-1.0 / in_run.tau_s);
    F.block<3, 3>(bias, row).diagonal().setConstant(1.0 / filter_tau_s - 1.0 / in_run.tau_s);
    for (const int i : {bias, row}) {
      for (const int j : {bias, row}) Q.block<3, 3>(i, j).diagonal().setConstant(drive);
    }
  }

  const sim::Scene& scene_;
  ErrorMatrix filter_P_;
  Matrix P_{Matrix::Zero()};
  double last_fix_s_{0.0};
};

}  // namespace leeway::test
