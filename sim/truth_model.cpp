#include "truth_model.hpp"

#include <cmath>
#include <limits>

namespace leeway::sim {
namespace {

/// The sources of a triad, in the order accelerometer, gyro.
ErrorSource of_triad(int bias_row, ErrorSource accelerometer, ErrorSource gyro) {
  return bias_row == kBa ? accelerometer : gyro;
}

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
  white(ErrorSource::kInitial).P += initial_nav;
  add_triad(scene.imu.accelerometer, kBa, filter.tau_a_s);
  add_triad(scene.imu.gyro, kBg, filter.tau_g_s);
  const GnssErrorModel& gnss = scene.gnss.errors;
  white(ErrorSource::kGnssPosition).fix_variance.head<3>() += gnss.position_sigma_n_m.cwiseAbs2();
  white(ErrorSource::kGnssVelocity).fix_variance.tail<3>() += gnss.velocity_sigma_n_mps.cwiseAbs2();
  if (!gnss.correlated_sigma_n_m.isZero(0.0)) {
    const Eigen::Matrix3d variance = gnss.correlated_sigma_n_m.cwiseAbs2().asDiagonal();
    markov_.emplace_back(
        ErrorSource::kGnssCorrelated,
        MarkovSource(MarkovSource::kFixes, variance, 0.0, gnss.correlation_time_s, 0.0));
  }
}

WhiteSource& TruthModel::white(ErrorSource source) {
  if (white_.empty() || by_source_) white_.emplace_back(source, WhiteSource{});
  return white_.back().second;
}

void TruthModel::add_triad(const TriadErrorModel& triad, int bias_row, double filter_tau_s) {
  const double density = triad.noise_density * triad.noise_density;
  ProcessNoise& noise =
      white(of_triad(bias_row, ErrorSource::kAccelerometerNoise, ErrorSource::kGyroNoise)).noise;
  (bias_row == kBa ? noise.velocity_m2_per_s3 : noise.attitude_rad2_per_s) += density;

  const ErrorSource bias =
      of_triad(bias_row, ErrorSource::kAccelerometerBias, ErrorSource::kGyroBias);
  const Eigen::Matrix3d turn_on =
      triad.bias_sigma * triad.bias_sigma * Eigen::Matrix3d::Identity() +
      triad.bias * triad.bias.transpose();
  if (std::isinf(filter_tau_s)) {
    white(bias).P.block<3, 3>(bias_row, bias_row) += turn_on;
  } else if (!turn_on.isZero(0.0)) {
    const double constant_s = std::numeric_limits<double>::infinity();
    markov_.emplace_back(bias, MarkovSource(bias_row, turn_on, 0.0, constant_s, filter_tau_s));
  }

  const ErrorSource drift =
      of_triad(bias_row, ErrorSource::kAccelerometerDrift, ErrorSource::kGyroDrift);
  const GaussMarkov& in_run = triad.in_run;
  const double variance = in_run.sigma * in_run.sigma;
  if (variance == 0.0) return;
  if (in_run.tau_s == filter_tau_s) {
    WhiteSource& source = white(drift);
    source.P.block<3, 3>(bias_row, bias_row).diagonal().array() += variance;
    const double drive = std::isinf(in_run.tau_s) ? 0.0 : 2.0 * variance / in_run.tau_s;
    (bias_row == kBa ? source.noise.b_a_m2_per_s5 : source.noise.b_g_rad2_per_s3) += drive;
  } else {
    markov_.emplace_back(drift, MarkovSource(bias_row, variance * Eigen::Matrix3d::Identity(),
                                             in_run.sigma, in_run.tau_s, filter_tau_s));
  }
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
  if (by_source_ || !markov_.empty() || !parameter_moments_.empty()) return false;
  const WhiteSource& all = white_.front().second;
  return all.P.isApprox(filter_P, 1e-12) && same(all.noise, filter) &&
         all.fix_variance.isApprox(filter_fix_variance, 1e-12);
}

void TruthModel::propagate(const Leg& leg) {
  for (auto& [source, white] : white_) white.propagate(leg);
  for (auto& [source, markov] : markov_) markov.propagate(leg);
  if (!parameter_moments_.empty()) parameters_.propagate(leg);
}

void TruthModel::update(const ScalarGain& gain) {
  for (auto& [source, white] : white_) white.update(gain);
  for (auto& [source, markov] : markov_) markov.update(gain);
  if (!parameter_moments_.empty()) parameters_.update(gain);
}

ErrorMatrix TruthModel::covariance() const {
  ErrorMatrix sum = ErrorMatrix::Zero();
  for (const auto& [source, white] : white_) sum += white.P;
  for (const auto& [source, markov] : markov_) sum += markov.covariance();
  if (parameter_moments_.empty()) return sum;
  ParameterMoment moment = ParameterMoment::Zero();
  for (const auto& [source, own] : parameter_moments_) moment += own;
  return sum + parameters_.covariance(moment);
}

ErrorBudget TruthModel::budget(const Eigen::Matrix3d& C_en) const {
  ErrorBudget budget;
  const auto add = [&](ErrorSource source, const ErrorMatrix& P) {
    budget.push_back({source, C_en.transpose() * P.block<3, 3>(kDr, kDr) * C_en});
  };
  for (const auto& [source, white] : white_) add(source, white.P);
  for (const auto& [source, markov] : markov_) add(source, markov.covariance());
  for (const auto& [source, moment] : parameter_moments_) {
    add(source, parameters_.covariance(moment));
  }
  return budget;
}

}  // namespace leeway::sim
