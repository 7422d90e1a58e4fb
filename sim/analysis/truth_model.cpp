#include "sim/analysis/truth_model.hpp"

#include <algorithm>
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

template <int kFilters>
TruthModel<kFilters>::TruthModel(const Scene& scene, const ErrorMatrix& initial_nav,
                                 const std::array<ProcessNoise, kFilters>& filters, bool by_source)
    : filters_(filters), by_source_(by_source), parameter_moments_(parameter_moments(scene.imu)) {
  of(ErrorSource::kInitial).add_shared(0, initial_nav);
  const ImuErrorModel& believed = scene.filter.imu;
  add_triad(scene.imu.accelerometer, kBa, believed.accelerometer.bias);
  add_triad(scene.imu.gyro, kBg, believed.gyro.bias);
  const GnssErrorModel& gnss = scene.gnss.errors;
  of(ErrorSource::kGnssPosition).fix_variance.template head<3>() +=
      gnss.position_sigma_n_m.cwiseAbs2();
  of(ErrorSource::kGnssVelocity).fix_variance.template tail<3>() +=
      gnss.velocity_sigma_n_mps.cwiseAbs2();
  if (gnss.correlated_sigma_n_m.isZero(0.0)) return;
  MarkovSource<kFilters> source;
  source.process.tau_s = gnss.correlation_time_s;  // its drive never enters the error
  MarkovStart start;
  start.variance = gnss.correlated_sigma_n_m.cwiseAbs2();
  of(ErrorSource::kGnssCorrelated).add_process(source, start);
}

template <int kFilters>
SourceCovariance<kFilters>& TruthModel<kFilters>::of(ErrorSource source) {
  if (sources_.empty() || by_source_) {
    sources_.emplace_back(source, SourceCovariance<kFilters>(filters_));
  }
  return sources_.back().second;
}

template <int kFilters>
bool TruthModel<kFilters>::all_take_bias_for(double tau_s, int bias_row) const {
  return std::all_of(filters_.begin(), filters_.end(), [&](const ProcessNoise& filter) {
    return (bias_row == kBa ? filter.tau_a_s : filter.tau_g_s) == tau_s;
  });
}

template <int kFilters>
void TruthModel<kFilters>::add_triad(const TriadErrorModel& triad, int bias_row,
                                     const Eigen::Vector3d& known_bias) {
  const auto of_triad = [&](ErrorSource accelerometer,
                            ErrorSource gyro) -> SourceCovariance<kFilters>& {
    return of(bias_row == kBa ? accelerometer : gyro);
  };
  ProcessNoise& noise = of_triad(ErrorSource::kAccelerometerNoise, ErrorSource::kGyroNoise).noise;
  (bias_row == kBa ? noise.velocity_m2_per_s3 : noise.attitude_rad2_per_s) +=
      triad.noise_density * triad.noise_density;
  MarkovStart turn_on;
  turn_on.variance.setConstant(triad.bias_sigma * triad.bias_sigma);
  turn_on.mean = triad.bias;
  turn_on.known = known_bias;
  add_turn_on(turn_on, bias_row, of_triad(ErrorSource::kAccelerometerBias, ErrorSource::kGyroBias));
  if (triad.in_run.sigma == 0.0) return;
  add_drift(triad.in_run, bias_row,
            of_triad(ErrorSource::kAccelerometerDrift, ErrorSource::kGyroDrift));
}

template <int kFilters>
void TruthModel<kFilters>::add_turn_on(const MarkovStart& turn_on, int bias_row,
                                       SourceCovariance<kFilters>& bias) {
  if (all_take_bias_for(std::numeric_limits<double>::infinity(), bias_row)) {
    // The states are as constant as the bias: nothing else need be remembered.
    bias.add_shared(bias_row, turn_on.error_moment());
  } else if (!turn_on.variance.isZero(0.0) || !turn_on.mean.isZero(0.0) ||
             !turn_on.known.isZero(0.0)) {
    bias.add_process({bias_row, GaussMarkov{}}, turn_on);
  }
}

template <int kFilters>
void TruthModel<kFilters>::add_drift(const GaussMarkov& in_run, int bias_row,
                                     SourceCovariance<kFilters>& drift) {
  MarkovStart start;
  start.variance.setConstant(in_run.sigma * in_run.sigma);
  if (kFilters > 1 || !all_take_bias_for(in_run.tau_s, bias_row)) {
    drift.add_process({bias_row, in_run}, start);
    return;
  }
  // The filter's own state is the drift.
  drift.add_shared(bias_row, start.error_moment());
  const double drive = std::isinf(in_run.tau_s) ? 0.0 : 2.0 * start.variance.x() / in_run.tau_s;
  (bias_row == kBa ? drift.noise.b_a_m2_per_s5 : drift.noise.b_g_rad2_per_s3) += drive;
}

template <int kFilters>
bool TruthModel<kFilters>::is_known_to(
    const ErrorMoment<kFilters>& filter_P,
    const Eigen::Matrix<double, 6, 1>& filter_fix_variance) const {
  const SourceCovariance<kFilters>& all = sources_.front().second;
  if (by_source_ || all.has_processes() || !parameter_moments_.empty()) return false;
  return all.P.isApprox(filter_P, 1e-12) && same(all.noise, filters_.front()) &&
         all.fix_variance.isApprox(filter_fix_variance, 1e-12);
}

template <int kFilters>
void TruthModel<kFilters>::propagate(const Leg& leg) {
  for (auto& [name, source] : sources_) source.propagate(leg);
  if (!parameter_moments_.empty()) parameters_.propagate(leg);
}

template <int kFilters>
void TruthModel<kFilters>::update(const FixRows& fix, const FixGains<kFilters>& gains) {
  for (int row = 0; row < fix.H.rows(); ++row) {
    RowGain<kFilters> gain{row, fix.per_sigma(row), fix.H.row(row).transpose()};
    for (int i = 0; i < kFilters; ++i) {
      const int first = i * kErrorStates;
      gain.K.col(i).template segment<kErrorStates>(first) =
          gains.col(row).template segment<kErrorStates>(first);
    }
    for (auto& [name, source] : sources_) source.update(gain);
    if (!parameter_moments_.empty()) parameters_.update(gain);
  }
}

template <int kFilters>
ErrorMoment<kFilters> TruthModel<kFilters>::covariance() const {
  ErrorMoment<kFilters> sum = ErrorMoment<kFilters>::Zero();
  for (const auto& [name, source] : sources_) sum += source.P;
  if (parameter_moments_.empty()) return sum;
  ParameterMoment moment = ParameterMoment::Zero();
  for (const auto& [name, own] : parameter_moments_) moment += own;
  return sum + parameters_.covariance(moment);
}

template <int kFilters>
ErrorBudget TruthModel<kFilters>::error_budget(const Eigen::Matrix3d& C_en) const {
  ErrorBudget error_budget;
  const auto add = [&](ErrorSource name, const ErrorMoment<kFilters>& P) {
    error_budget.push_back({name, C_en.transpose() * P.template block<3, 3>(kDr, kDr) * C_en});
  };
  for (const auto& [name, source] : sources_) add(name, source.P);
  for (const auto& [name, moment] : parameter_moments_) add(name, parameters_.covariance(moment));
  return error_budget;
}

template class TruthModel<1>;
template class TruthModel<2>;

}  // namespace leeway::sim
