#include "sim/analysis/truth_model.hpp"

#include <cmath>
#include <limits>

#include "leeway/model/process_noise.hpp"

namespace leeway::sim {
namespace {

bool same(const ProcessNoise& a, const ProcessNoise& b) {
  return a.attitude_rad2_per_s == b.attitude_rad2_per_s &&
         a.velocity_m2_per_s3 == b.velocity_m2_per_s3 && a.b_a_m2_per_s5 == b.b_a_m2_per_s5 &&
         a.b_g_rad2_per_s3 == b.b_g_rad2_per_s3;
}

Eigen::Matrix3d off_diagonal(double value) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Constant(value);
  m.diagonal().setZero();
  return m;
}

}  // namespace

TruthModel::TruthModel(const Scene& scene, const ErrorMatrix& initial_nav,
                       const ProcessNoise& filter, bool by_source)
    : by_source_(by_source), parameter_moments_(parameter_moments(scene.imu)) {
  of(ErrorSource::kInitial).P += initial_nav;
  const ImuErrorModel& believed = scene.filter.imu;
  add_triad(scene.imu.accelerometer, kBa, believed.accelerometer.bias, filter.tau_a_s);
  add_triad(scene.imu.gyro, kBg, believed.gyro.bias, filter.tau_g_s);
  const GnssErrorModel& gnss = scene.gnss.errors;
  of(ErrorSource::kGnssPosition).fix_variance.head<3>() += gnss.position_sigma_n_m.cwiseAbs2();
  of(ErrorSource::kGnssVelocity).fix_variance.tail<3>() += gnss.velocity_sigma_n_mps.cwiseAbs2();
  if (gnss.correlated_sigma_n_m.isZero(0.0)) return;
  MarkovSource source;
  source.process.tau_s = gnss.correlation_time_s;  // its drive never enters the error
  MarkovStart start;
  start.variance = gnss.correlated_sigma_n_m.cwiseAbs2();
  of(ErrorSource::kGnssCorrelated).add_process(source, start);
}

SourceCovariance& TruthModel::of(ErrorSource source) {
  if (sources_.empty() || by_source_) sources_.emplace_back(source, SourceCovariance{});
  return sources_.back().second;
}

void TruthModel::add_triad(const TriadErrorModel& triad, int bias_row,
                           const Eigen::Vector3d& known_bias, double filter_tau_s) {
  const auto of_triad = [bias_row](ErrorSource accelerometer, ErrorSource gyro) {
    return bias_row == kBa ? accelerometer : gyro;
  };
  ProcessNoise& noise =
      of(of_triad(ErrorSource::kAccelerometerNoise, ErrorSource::kGyroNoise)).noise;
  (bias_row == kBa ? noise.velocity_m2_per_s3 : noise.attitude_rad2_per_s) +=
      triad.noise_density * triad.noise_density;

  SourceCovariance& bias = of(of_triad(ErrorSource::kAccelerometerBias, ErrorSource::kGyroBias));
  MarkovStart turn_on;
  turn_on.variance.setConstant(triad.bias_sigma * triad.bias_sigma);
  turn_on.mean = triad.bias;
  turn_on.known = known_bias;
  if (std::isinf(filter_tau_s)) {
    // The state is as constant as the bias: nothing else need be remembered.
    const Eigen::Vector3d error = turn_on.mean - turn_on.known;
    const Eigen::Matrix3d variance = turn_on.variance.asDiagonal();
    bias.P.block<3, 3>(bias_row, bias_row) += variance + error * error.transpose();
  } else if (!turn_on.variance.isZero(0.0) || !turn_on.mean.isZero(0.0) ||
             !turn_on.known.isZero(0.0)) {
    bias.add_process({bias_row, GaussMarkov{}, filter_tau_s}, turn_on);
  }
  if (triad.in_run.sigma == 0.0) return;
  add_drift(triad.in_run, bias_row,
            of(of_triad(ErrorSource::kAccelerometerDrift, ErrorSource::kGyroDrift)), filter_tau_s);
}

void TruthModel::add_drift(const GaussMarkov& in_run, int bias_row, SourceCovariance& drift,
                           double filter_tau_s) {
  MarkovStart start;
  start.variance.setConstant(in_run.sigma * in_run.sigma);
  if (in_run.tau_s != filter_tau_s) {
    drift.add_process({bias_row, in_run, filter_tau_s}, start);
    return;
  }
  // The filter's own state is the drift.
  drift.P.block<3, 3>(bias_row, bias_row).diagonal() += start.variance;
  const double drive = std::isinf(in_run.tau_s) ? 0.0 : 2.0 * start.variance.x() / in_run.tau_s;
  (bias_row == kBa ? drift.noise.b_a_m2_per_s5 : drift.noise.b_g_rad2_per_s3) += drive;
}

TruthModel::ParameterMoments TruthModel::parameter_moments(const ImuErrorModel& imu) {
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

bool TruthModel::is_known_to(const ErrorMatrix& filter_P, const ProcessNoise& filter,
                             const Eigen::Matrix<double, 6, 1>& filter_fix_variance) const {
  const SourceCovariance& all = sources_.front().second;
  if (by_source_ || all.has_processes() || !parameter_moments_.empty()) return false;
  return all.P.isApprox(filter_P, 1e-12) && same(all.noise, filter) &&
         all.fix_variance.isApprox(filter_fix_variance, 1e-12);
}

void TruthModel::propagate(const Leg& leg) {
  for (auto& [name, source] : sources_) source.propagate(leg);
  if (!parameter_moments_.empty()) parameters_.propagate(leg);
}

void TruthModel::update(const ScalarGain& gain) {
  for (auto& [name, source] : sources_) source.update(gain);
  if (!parameter_moments_.empty()) parameters_.update(gain);
}

ErrorMatrix TruthModel::covariance() const {
  ErrorMatrix sum = ErrorMatrix::Zero();
  for (const auto& [name, source] : sources_) sum += source.P;
  if (parameter_moments_.empty()) return sum;
  ParameterMoment moment = ParameterMoment::Zero();
  for (const auto& [name, own] : parameter_moments_) moment += own;
  return sum + parameters_.covariance(moment);
}

ErrorBudget TruthModel::budget(const Eigen::Matrix3d& C_en) const {
  ErrorBudget budget;
  const auto add = [&](ErrorSource name, const ErrorMatrix& P) {
    budget.push_back({name, C_en.transpose() * P.block<3, 3>(kDr, kDr) * C_en});
  };
  for (const auto& [name, source] : sources_) add(name, source.P);
  for (const auto& [name, moment] : parameter_moments_) add(name, parameters_.covariance(moment));
  return budget;
}

}  // namespace leeway::sim
