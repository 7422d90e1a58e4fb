#include "leeway/ekf/ekf.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "filters/covariance/cholesky.hpp"
#include "filters/covariance/measurement_update.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/model/chi_square.hpp"
#include "leeway/model/gnss_measurement.hpp"

namespace leeway {
namespace {

constexpr double kCoastTurnRadps = 0.5;
constexpr double kCoastMaxTurnRad = 1.0;  // beyond, the linearized filter does not find back
constexpr double kCoastTiltRad = 0.1;     // roads lean; they do not turn vehicles over
constexpr double kCoastAccelerationMps2 = 3.0;

void validate(const Estimate& estimate) {
  const NavState& nav = estimate.nav;
  if (!nav.v_e_mps.allFinite() || !nav.r_e_m.allFinite() || !nav.q_eb.coeffs().allFinite()) {
    throw Error("initial navigation state: every element must be finite");
  }
  if (std::abs(nav.q_eb.norm() - 1.0) > 1e-9) {
    throw Error("initial q_eb has norm " + std::to_string(nav.q_eb.norm()) +
                ", must be 1 within 1e-9: call normalize()");
  }
  if (!(nav.r_e_m.norm() > 6.3e6)) {
    throw Error("initial r_e_m is " + std::to_string(nav.r_e_m.norm()) +
                " m from the Earth's centre, must be above 6.3e6 m: ECEF coordinates are wanted");
  }
}

void validate(const ErrorMatrix& P) {
  if (!P.allFinite() || P.diagonal().minCoeff() < 0.0 ||
      (P - P.transpose()).cwiseAbs().maxCoeff() > 1e-9 * P.cwiseAbs().maxCoeff()) {
    throw Error("initial covariance: must be finite, symmetric, with no negative diagonal element");
  }
}

/// The directions of the error state that an update leaves alone, as columns; zero for none.
using HeldDirections = Eigen::Matrix<double, kErrorStates, 2>;

HeldDirections directions_of(Held held, const Estimate& estimate) {
  HeldDirections U = HeldDirections::Zero();
  if (held == Held::kNothing) return U;
  const Eigen::Vector3d down_e = down_e_at(estimate.nav.r_e_m);
  U.col(0).segment<3>(kPsi) = down_e;
  if (held == Held::kHeadingAndTurn) {
    U.col(1).segment<3>(kBg) = estimate.nav.q_eb.conjugate() * down_e;
  }
  return U;
}

/// scalar_update() with a gain that has nothing along U. By Joseph's form with that gain, P is the
/// one of the full update and s d d^T, s the innovation's variance and d the gain left out.
template <class Matrix, class Vector>
void held_scalar_update(Matrix& P, Vector& x, const Vector& h, double z, const HeldDirections& U) {
  const Vector Ph = P * h;
  const double s = h.dot(Ph) + 1.0;
  Vector left_out = Vector::Zero();
  left_out.template head<kErrorStates>() =
      U * (U.transpose() * Ph.template head<kErrorStates>()) / s;
  const double innovation = z - h.dot(x);
  scalar_update(P, x, h, z);
  x -= innovation * left_out;
  P += s * left_out * left_out.transpose();
}

/// A measurement of unit variances, as columns of N states.
template <int N>
struct WhiteColumns {
  int rows;
  RowColumns<double, N> H;
  RowValues<double> z;
};

/// Whitened by the Cholesky factor of R, the components are independent, of unit variance.
template <int N>
WhiteColumns<N> whitened(const Measurement& m, const Eigen::Matrix<double, 6, 1>& weights) {
  WhiteColumns<N> white{m.rows(), RowColumns<double, N>::Zero(), RowValues<double>::Zero()};
  const Cholesky<6> R_factor(m.R);
  for (int i = 0; i < white.rows; ++i) {
    for (int k = 0; k < kErrorStates; ++k) white.H(k, i) = m.H(i, k);
    for (int k = kErrorStates; k < N; ++k) white.H(k, i) = m.H_vehicle(i, k - kErrorStates);
    white.z(i) = m.innovation(i);
  }
  R_factor.whiten(white.H.transpose());
  R_factor.whiten(white.z);
  for (int i = 0; i < white.rows; ++i) {
    white.H.col(i) *= weights(i);
    white.z(i) *= weights(i);
  }
  return white;
}

/// Takes the measurement into P. @returns the correction of the estimate.
template <int N>
Eigen::Matrix<double, N, 1> correction_by(Eigen::Matrix<double, N, N>& P, const WhiteColumns<N>& m,
                                          const HeldDirections& U) {
  Eigen::Matrix<double, N, 1> x = Eigen::Matrix<double, N, 1>::Zero();
  const bool nothing_held = U.isZero(0.0);
  if (nothing_held &&
      update_at_once<double, N>(P, x, m.rows, m.H, m.z, kJosephShrinkage).has_value()) {
    return x;
  }
  for (int i = 0; i < m.rows; ++i) {
    const Eigen::Matrix<double, N, 1> h = m.H.col(i);
    if (nothing_held) {
      scalar_update(P, x, h, m.z(i));
    } else {
      held_scalar_update(P, x, h, m.z(i), U);
    }
  }
  return x;
}

/// Of biases that are no states the variance is zero.
bool has_positive_variances(const ErrorMatrix& P) {
  return P.diagonal().head<kBa>().minCoeff() > 0.0 &&
         P.diagonal().tail<kErrorStates - kBa>().minCoeff() >= 0.0;
}

double nis_of(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& S) {
  return Cholesky<3>(S).normalized_square(innovation);
}

}  // namespace

void validate(const EkfConfig& config, const Estimate& estimate) {
  validate(config);
  validate(estimate);
}

Ekf::Ekf(const EkfConfig& config, const Estimate& estimate, const ErrorMatrix& P)
    : config_(config),
      noise_(process_noise(config.imu, config.biases)),
      strapdown_step_(strapdown_function(config.strapdown)),
      estimate_(estimate),
      P_(P) {
  validate(config, estimate);
  validate(P);
  for (std::size_t dof = 1; dof < gate_.size(); ++dof) {
    gate_[dof] = config.gate_probability > 0.0
                     ? chi_square_threshold(config.gate_probability, static_cast<int>(dof))
                     : std::numeric_limits<double>::infinity();
  }
}

void Ekf::predict(const ImuIncrement& inc) {
  ImuIncrement corrected = inc;
  corrected.dtheta_b_rad -= inc.dt_s * estimate_.bias.b_g_radps;
  corrected.dv_b_mps -= inc.dt_s * estimate_.bias.b_a_mps2;
  omega_ib_b_radps_ = 1.0 / inc.dt_s * inc.dtheta_b_rad;
  mean_rate_window_s_ = std::max(std::min(mean_rate_window_s_ + inc.dt_s, kMeanRateS), inc.dt_s);
  mean_omega_ib_b_radps_ +=
      inc.dt_s / mean_rate_window_s_ * (omega_ib_b_radps_ - mean_omega_ib_b_radps_);

  // Once for each Phi: over the way of a covariance interval it changes by 3 parts of way / 6370
  // km.
  if (covariance_is_current() && config_.gravity_gradient) {
    gravity_gradient_e_ = gravity_gradient_e(estimate_.nav.r_e_m);
  }

  const StrapdownStep step = strapdown_step_(estimate_.nav, corrected, history_);

  const ErrorDynamics dynamics{.dt_s = inc.dt_s,
                               .C_eb_mean = step.C_eb_mean,
                               .dv_f_e_mps = step.dv_f_e_mps,
                               .gravity_gradient_e = gravity_gradient_e_,
                               .a_a = bias_decay(inc.dt_s, noise_.tau_a_s),
                               .g_g = bias_decay(inc.dt_s, noise_.tau_g_s)};
  estimate_.bias.b_a_mps2 *= dynamics.a_a;
  estimate_.bias.b_g_radps *= dynamics.g_g;
  if (config_.covariance_interval_s == 0.0 && Phi_.dt_s == 0.0 && !estimates_vehicle_) {
    propagate(P_, dynamics, noise_);  // Phi of the one increment need not be formed
    return;
  }
  advance(Phi_, dynamics);
  // Half an increment of slack, so that rounding does not shift the moment.
  if (Phi_.dt_s + 0.5 * inc.dt_s > config_.covariance_interval_s) flush();
}

void Ekf::coast(Time to) {
  flush();
  const double dt_s = to_seconds(to - estimate_.nav.time);
  estimate_.nav.r_e_m += dt_s * estimate_.nav.v_e_mps;
  estimate_.nav.time = to;
  Phi_.dt_s = dt_s;
  Phi_.r.middleCols<3>(kDv) = dt_s * Eigen::Matrix3d::Identity();
  flush();
  const double turn_rad = std::min(kCoastTurnRadps * dt_s, kCoastMaxTurnRad);
  const double tilt_rad = std::min(turn_rad, kCoastTiltRad);
  const double velocity_mps = kCoastAccelerationMps2 * dt_s;
  const double position_m = 0.5 * velocity_mps * dt_s;
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(estimate_.nav.r_e_m));
  const Eigen::Vector3d psi_n(tilt_rad, tilt_rad, turn_rad);
  P_.block<3, 3>(kPsi, kPsi) += C_en * psi_n.cwiseAbs2().asDiagonal() * C_en.transpose();
  P_.diagonal().segment<3>(kDv).array() += velocity_mps * velocity_mps;
  P_.diagonal().segment<3>(kDr).array() += position_m * position_m;
  P_.block<3, 3>(kDv, kDr).diagonal().array() += velocity_mps * position_m;
  P_.block<3, 3>(kDr, kDv).diagonal().array() += velocity_mps * position_m;
}

MeasurementMatrix Ekf::innovation_covariance(const Measurement& m) const {
  MeasurementMatrix S = m.R;
  for (int i = 0; i < m.rows(); ++i) {
    const ErrorVector h = m.H.row(i);
    ErrorVector Ph = P_ * h;
    VehicleVector Ph_vehicle = VehicleVector::Zero();
    if (estimates_vehicle_) {
      const VehicleVector h_vehicle = m.H_vehicle.row(i);
      Ph += vehicle_.cross * h_vehicle;
      Ph_vehicle = vehicle_.cross.transpose() * h + vehicle_.P * h_vehicle;
    }
    for (int j = i; j < m.rows(); ++j) {
      S(j, i) += m.H.row(j).dot(Ph) + m.H_vehicle.row(j).dot(Ph_vehicle);
      S(i, j) = S(j, i);
    }
  }
  return S;
}

UpdateOutcome Ekf::judge(const Measurement& m) {
  flush();
  UpdateOutcome report;
  report.time = estimate_.nav.time;
  report.dof = m.rows();
  report.gate = gate_[static_cast<std::size_t>(report.dof)];
  const MeasurementMatrix S = innovation_covariance(m);
  if (m.rows() == 6) {
    report.position_nis = nis_of(m.innovation.head<3>(), S.topLeftCorner<3, 3>());
    report.velocity_nis = nis_of(m.innovation.tail<3>(), S.bottomRightCorner<3, 3>());
  }
  const Cholesky<6> S_factor(S);
  report.covariance_positive = S_factor.positive();
  if (!report.covariance_positive) return report;
  report.nis = S_factor.normalized_square(m.innovation);
  report.log_det_S = S_factor.log_det();
  report.outcome =
      report.nis <= report.gate ? UpdateOutcome::Outcome::kFused : UpdateOutcome::Outcome::kGated;
  return report;
}

void Ekf::fuse(const Measurement& m, const Eigen::Matrix<double, 6, 1>& weights, Held held) {
  const HeldDirections U = directions_of(held, estimate_);
  ErrorVector x_hat;
  if (estimates_vehicle_) {
    JointMatrix P;
    P << P_, vehicle_.cross, vehicle_.cross.transpose(), vehicle_.P;
    const JointVector x_joint = correction_by(P, whitened<kJointStates>(m, weights), U);
    P_ = P.topLeftCorner<kErrorStates, kErrorStates>();
    vehicle_.cross = P.topRightCorner<kErrorStates, kVehicleStates>();
    vehicle_.P = P.bottomRightCorner<kVehicleStates, kVehicleStates>();
    vehicle_.value += x_joint.tail<kVehicleStates>();
    x_hat = x_joint.head<kErrorStates>();
  } else {
    x_hat = correction_by(P_, whitened<kErrorStates>(m, weights), U);
  }
  inject(estimate_, x_hat);
  const Eigen::Matrix3d J = reset_jacobian(x_hat);
  transform_block(P_, kPsi, J);
  if (estimates_vehicle_) {
    vehicle_.cross.middleRows<3>(kPsi) = (J * vehicle_.cross.middleRows<3>(kPsi)).eval();
  }
}

UpdateOutcome Ekf::update(const GnssFix& fix, const FixTrust& trust) {
  if (!is_usable(fix)) {
    UpdateOutcome unusable;
    unusable.time = fix.time;
    return unusable;
  }
  Measurement m = gnss_measurement(fix, estimate_, config_.lever_arm_b_m, omega_ib_b_radps_);
  Eigen::Matrix<double, 6, 1> weights = Eigen::Matrix<double, 6, 1>::Ones();
  if (fix.position) {
    m.R.topLeftCorner<3, 3>() *= trust.position_sigma_scale * trust.position_sigma_scale;
    weights.head<3>().setConstant(position_weight(fix.time));
  }
  if (fix.velocity) {
    m.R.bottomRightCorner<3, 3>() *= trust.velocity_sigma_scale * trust.velocity_sigma_scale;
  }
  UpdateOutcome report = judge(m);
  if (!fix.velocity) report.position_nis = report.nis;
  if (!fix.position) report.velocity_nis = report.nis;
  if (fix.position) report.position_innovation_e_m = m.innovation.head<3>();
  if (fix.velocity) report.velocity_innovation_e_mps = m.innovation.tail<3>();
  if (report.outcome != UpdateOutcome::Outcome::kFused) return report;
  fuse(m, weights, trust.held);
  if (fix.position) last_position_fix_ = fix.time;
  report.covariance_positive = has_positive_variances(P_);
  return report;
}

UpdateOutcome Ekf::update(const Measurement& m, Held held) {
  UpdateOutcome report = judge(m);
  if (report.outcome != UpdateOutcome::Outcome::kFused) return report;
  fuse(m, Eigen::Matrix<double, 6, 1>::Ones(), held);
  report.covariance_positive = has_positive_variances(P_);
  return report;
}

double Ekf::heading_sigma_rad() const {
  return std::sqrt(std::max(0.0, heading_variance_rad2(estimate_, P_)));
}

bool Ekf::rest_hides_heading() const {
  return leeway::rest_hides_heading(config_.imu, estimate_, P_);
}

void Ekf::estimate_vehicle(const VehicleState& vehicle) {
  flush();
  vehicle_ = vehicle;
  estimates_vehicle_ = true;
}

void Ekf::widen(double factor) {
  flush();
  P_ *= factor;
  vehicle_.P *= factor;
  vehicle_.cross *= factor;
}

void Ekf::widen_position(double variance_m2) {
  flush();
  P_.diagonal().segment<3>(kDr).array() += variance_m2;
}

void Ekf::turn_body_axes(const Eigen::Matrix3d& C_new_old, const Eigen::Vector3d& lever_arm_b_m) {
  flush();
  config_.lever_arm_b_m = lever_arm_b_m;
  estimate_.nav.q_eb =
      (estimate_.nav.q_eb * Eigen::Quaterniond(C_new_old.transpose())).normalized();
  estimate_.bias.b_a_mps2 = C_new_old * estimate_.bias.b_a_mps2;
  estimate_.bias.b_g_radps = C_new_old * estimate_.bias.b_g_radps;
  for (const int bias : {kBa, kBg}) transform_block(P_, bias, C_new_old);
  omega_ib_b_radps_ = C_new_old * omega_ib_b_radps_;
  mean_omega_ib_b_radps_ = C_new_old * mean_omega_ib_b_radps_;
  history_ = ImuHistory{};
  vehicle_ = VehicleState{};
  estimates_vehicle_ = false;
}

void Ekf::restart_motion(const Eigen::Vector3d& r_e_m, const Eigen::Matrix3d& P_rr_m2,
                         const Eigen::Vector3d& v_e_mps, const Eigen::Matrix3d& P_vv_m2ps2) {
  flush();
  estimate_.nav.r_e_m = r_e_m;
  estimate_.nav.v_e_mps = v_e_mps;
  P_.middleRows<6>(kDv).setZero();
  P_.middleCols<6>(kDv).setZero();
  P_.block<3, 3>(kDv, kDv) = P_vv_m2ps2;
  P_.block<3, 3>(kDr, kDr) = P_rr_m2;
  vehicle_.cross.middleRows<6>(kDv).setZero();
}

bool Ekf::is_sane() const {
  constexpr double kLargest = 1e30;
  const double sizes = estimate_.nav.r_e_m.squaredNorm() + estimate_.nav.v_e_mps.squaredNorm() +
                       estimate_.nav.q_eb.squaredNorm() + estimate_.bias.b_a_mps2.squaredNorm() +
                       estimate_.bias.b_g_radps.squaredNorm();
  return sizes < kLargest && P_.cwiseAbs().sum() < kLargest;
}

bool Ekf::repair_covariance() {
  if (is_positive_definite(P_)) return true;
  constexpr double kFloor = 1e-9;
  // Of the correlations, so that no state is small beside another for its unit alone.
  const ErrorVector sigma = P_.diagonal().cwiseAbs().cwiseSqrt().cwiseMax(1e-12);
  const ErrorVector inverse = sigma.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<ErrorMatrix> eigen(
      ErrorMatrix(inverse.asDiagonal() * P_ * inverse.asDiagonal()));
  const ErrorVector raised = eigen.eigenvalues().cwiseMax(kFloor);
  const ErrorMatrix correlation =
      eigen.eigenvectors() * raised.asDiagonal() * eigen.eigenvectors().transpose();
  P_ = sigma.asDiagonal() * correlation * sigma.asDiagonal();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  return false;
}

double Ekf::position_weight(Time t) const {
  if (!last_position_fix_) return 1.0;
  return gnss_position_weight(to_seconds(t - *last_position_fix_), config_.gnss_correlation_s);
}

ErrorMatrix Ekf::covariance() const {
  ErrorMatrix P = P_;
  propagate(P, Phi_, noise_);
  return P;
}

void Ekf::flush() {
  if (covariance_is_current()) return;
  propagate(P_, Phi_, noise_);
  if (estimates_vehicle_) {
    vehicle_.cross = times(Phi_, vehicle_.cross);
    vehicle_.P.diagonal() += Phi_.dt_s * vehicle_.random_walk_per_s;
  }
  Phi_ = Transition{};
}

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

bool rest_hides_heading(const ImuErrorModel& imu, const Estimate& estimate, const ErrorMatrix& P) {
  const double bias_radps = std::hypot(imu.gyro.bias_sigma, imu.gyro.in_run.sigma);
  const Eigen::Vector3d down_e = down_e_at(estimate.nav.r_e_m);
  const double level_rate_radps = earth_rotation_e_radps().cross(down_e).norm();
  const double heading_sigma_rad = std::sqrt(std::max(0.0, heading_variance_rad2(estimate, P)));
  return bias_radps > level_rate_radps * heading_sigma_rad;
}

bool is_positive_definite(const ErrorMatrix& P) { return Cholesky<kErrorStates>(P).positive(); }

double heading_variance_rad2(const Estimate& estimate, const ErrorMatrix& P) {
  const Eigen::Vector3d down_e = down_e_at(estimate.nav.r_e_m);
  return down_e.dot(P.block<3, 3>(kPsi, kPsi) * down_e);
}

Ekf filter_anywhere(const EkfConfig& config) {
  Estimate somewhere;
  somewhere.nav.r_e_m.x() = wgs84::kSemiMajorAxisM;
  return Ekf(config, somewhere, ErrorMatrix::Identity());
}

Solution solution(const Estimate& estimate, const ErrorMatrix& P) {
  const NavStateNed ned = ned_from_nav_state(estimate.nav);
  const Eigen::Matrix3d C_ne = ned_to_ecef(ned.position).transpose();
  const auto sigma_n = [&](int i) -> Eigen::Vector3d {
    return (C_ne * P.block<3, 3>(i, i) * C_ne.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
  };
  // Small turns about north, east and down as changes of roll, pitch and yaw. Near pitch +-90 deg
  // roll and yaw lose their meaning; the bound keeps their sigmas finite.
  const auto [roll, pitch, yaw] = ned.attitude;
  const double cos_pitch = std::max(std::cos(pitch), 1e-3);
  Eigen::Matrix3d euler_from_psi;
  euler_from_psi << std::cos(yaw) / cos_pitch, std::sin(yaw) / cos_pitch, 0.0,  //
      -std::sin(yaw), std::cos(yaw), 0.0,                                       //
      std::cos(yaw) * std::sin(pitch) / cos_pitch, std::sin(yaw) * std::sin(pitch) / cos_pitch, 1.0;
  const Eigen::Matrix3d to_euler = euler_from_psi * C_ne;

  Solution s;
  s.nav = estimate.nav;
  s.b_a_mps2 = estimate.bias.b_a_mps2;
  s.b_g_radps = estimate.bias.b_g_radps;
  s.sigma_position_n_m = sigma_n(kDr);
  s.sigma_velocity_n_mps = sigma_n(kDv);
  s.sigma_attitude_rad = (to_euler * P.block<3, 3>(kPsi, kPsi) * to_euler.transpose())
                             .diagonal()
                             .cwiseMax(0.0)
                             .cwiseSqrt();
  s.sigma_b_a_mps2 = P.diagonal().segment<3>(kBa).cwiseMax(0.0).cwiseSqrt();
  s.sigma_b_g_radps = P.diagonal().segment<3>(kBg).cwiseMax(0.0).cwiseSqrt();
  return s;
}

}  // namespace leeway
