/// @file
/// All the sources of a scene's error together, in one filter or in several. Part of
/// covariance_analysis.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "leeway/model/process_noise.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "sim/analysis/source_covariance.hpp"

namespace leeway::sim {

/// E[p p^T] of the sensors' parameters of each source that has any.
using ParameterMoment = Eigen::Matrix<double, kSensorParameters, kSensorParameters>;
using ParameterMoments = std::vector<std::pair<ErrorSource, ParameterMoment>>;
ParameterMoments parameter_moments(const ImuErrorModel& imu);

template <int kFilters, int kParameters = 0>
class TruthModel {
 public:
  /// @param initial_nav  covariance of attitude, velocity and position at the start, of all filters
  /// @param filters      what they take for the noise
  /// @param by_source    keeps the sources apart; else they share one covariance
  TruthModel(const Scene& scene, const ErrorMatrix& initial_nav,
             const std::array<ProcessNoise, kFilters>& filters, bool by_source)
      : filters_(filters),
        by_source_(by_source),
        parameter_moments_(std::make_shared<const ParameterMoments>(parameter_moments(scene.imu))) {
    for (const auto& [name, own] : *parameter_moments_) all_moments_ += own;
    of(ErrorSource::kInitial).add_shared(0, initial_nav);
    const ImuErrorModel& believed = scene.filter.imu;
    add_triad(scene.imu.accelerometer, kBa, believed.accelerometer.bias);
    add_triad(scene.imu.gyro, kBg, believed.gyro.bias);
    const GnssErrorModel& gnss = scene.gnss.errors;
    of(ErrorSource::kGnssPosition).row_variance.template head<3>() +=
        gnss.position_sigma_n_m.cwiseAbs2();
    of(ErrorSource::kGnssVelocity).row_variance.template segment<3>(3) +=
        gnss.velocity_sigma_n_mps.cwiseAbs2();
    of(ErrorSource::kGyroNoise).row_variance(kRateRow) +=
        scene.imu.gyro.noise_density * scene.imu.gyro.noise_density;
    if (scene.vehicle) add_vehicle(*scene.vehicle);
    if (gnss.correlated_sigma_n_m.isZero(0.0)) return;
    MarkovSource<kFilters, kParameters> source;
    source.process.tau_s = gnss.correlation_time_s;  // its drive never enters the error
    MarkovStart start;
    start.variance = gnss.correlated_sigma_n_m.cwiseAbs2();
    of(ErrorSource::kGnssCorrelated).add_process(source, start);
  }

  /// Whether the filter knows everything that goes on: its own covariance is then the true one.
  bool is_known_to(const ErrorMoment<kFilters, kParameters>& filter_P,
                   const Eigen::Matrix<double, 6, 1>& filter_fix_variance) const {
    const SourceCovariance<kFilters, kParameters>& all = sources_.front().second;
    if (by_source_ || !all.processes().empty() || !parameter_moments_->empty()) return false;
    return all.P.isApprox(filter_P, 1e-12) &&
           noise_variance(all.noise, 1.0) == noise_variance(filters_.front(), 1.0) &&
           all.row_variance.template head<6>().isApprox(filter_fix_variance, 1e-12);
  }

  /// Of the white noise of all sensors. @pre not by source
  const ProcessNoise& white_noise() const { return sources_.front().second.noise; }

  /// Whether stretches of many legs may be taken: no error has a memory of its own between fixes.
  bool takes_stretches() const {
    using Source = MarkovSource<kFilters, kParameters>;
    const auto enters_by_fixes = [](const Source& p) { return p.enters_at == Source::kFixes; };
    return !by_source_ && std::ranges::all_of(sources_.front().second.processes(), enters_by_fixes);
  }

  /// What RiccatiMap carries, all sources in one. @pre takes_stretches()
  SourceCovariance<kFilters, kParameters>& whole() { return sources_.front().second; }
  ParameterSources<kFilters, kParameters>* parameters() {
    return parameter_moments_->empty() ? nullptr : &parameters_;
  }

  /// @tparam Part  a Leg, or a Stretch where takes_stretches()
  template <class Part>
  void propagate(const Part& leg) {
    for (auto& [name, source] : sources_) source.propagate(leg);
    if (!parameter_moments_->empty()) parameters_.propagate(leg);
  }

  /// @param gains  on the rows one after the other: each sees the errors that the last one left
  void update(const FixRows& fix, const FixGains<kFilters, kParameters>& gains) {
    constexpr int kOwn = kErrorStates + kParameters;
    for (int row = 0; row < fix.H.rows(); ++row) {
      RowGain<kFilters, kParameters> gain{row, fix.per_sigma(row), fix.fixes};
      gain.h.template head<kErrorStates>() = fix.H.row(row).transpose();
      for (int i = 0; i < kFilters; ++i) {
        gain.K.col(i).template segment<kOwn>(i * kOwn) =
            gains.col(row).template segment<kOwn>(i * kOwn);
      }
      update(gain);
    }
  }

  void update(const RowGain<kFilters, kParameters>& gain) {
    for (auto& [name, source] : sources_) source.update(gain);
    if (!parameter_moments_->empty()) parameters_.update(gain);
  }

  ErrorMoment<kFilters, kParameters> covariance() const {
    ErrorMoment<kFilters, kParameters> sum = ErrorMoment<kFilters, kParameters>::Zero();
    for (const auto& [name, source] : sources_) sum += source.P;
    if (parameter_moments_->empty()) return sum;
    return sum + parameters_.covariance(all_moments_);
  }

  /// E[z z^T] of the position innovation, as CovariancePoint has it, of the first filter.
  Eigen::Matrix3d innovation_n_m2(const Eigen::Matrix3d& C_en) const {
    Eigen::Matrix3d moment = C_en.transpose() * covariance().template block<3, 3>(kDr, kDr) * C_en;
    for (const auto& [name, source] : sources_) {
      moment.diagonal() += source.row_variance.template head<3>();
      for (const auto& process : source.processes()) {
        if (process.enters_at >= 0) continue;  // not by the fixes
        const Eigen::Matrix3d cross = C_en.transpose() * process.S.template middleRows<3>(kDr);
        moment += cross + cross.transpose() + process.G;
      }
    }
    return moment;
  }

  /// Of the first filter.
  ErrorBudget error_budget(const Eigen::Matrix3d& C_en) const {
    ErrorBudget error_budget;
    const auto add = [&](ErrorSource name, const ErrorMoment<kFilters, kParameters>& P) {
      error_budget.push_back({name, C_en.transpose() * P.template block<3, 3>(kDr, kDr) * C_en});
    };
    for (const auto& [name, source] : sources_) add(name, source.P);
    for (const auto& [name, moment] : *parameter_moments_)
      add(name, parameters_.covariance(moment));
    return error_budget;
  }

 private:
  SourceCovariance<kFilters, kParameters>& of(ErrorSource source) {
    if (sources_.empty() || by_source_) {
      sources_.emplace_back(source, SourceCovariance<kFilters, kParameters>(filters_));
    }
    return sources_.back().second;
  }

  /// What the sensors of the vehicle really are: as bad as the filter takes them for.
  void add_vehicle(const SceneVehicle& vehicle) {
    const auto add = [&](const std::optional<VehicleSensor>& sensor, ErrorSource name, RowKind row,
                         int parameter) {
      if (!sensor) return;
      SourceCovariance<kFilters, kParameters>& source = of(name);
      source.row_variance(row) += sensor->sigma * sensor->sigma;
      if (kParameters == 0 || parameter < 0) return;
      const VehicleState believed = vehicle_state(vehicle.config);
      const int at = kErrorStates + parameter;
      source.P(at, at) += believed.P(parameter, parameter);
      source.walk_per_s(parameter) += believed.random_walk_per_s(parameter);
    };
    add(vehicle.odometer, ErrorSource::kOdometer, kOdometerRow, kOdometerScale);
    add(vehicle.barometer, ErrorSource::kBarometer, kBarometerRow, kHeightOffset);
    add(vehicle.heading, ErrorSource::kHeading, kHeadingRow, -1);
  }

  bool all_take_bias_for(double tau_s, int bias_row) const {
    return std::all_of(filters_.begin(), filters_.end(), [&](const ProcessNoise& filter) {
      return (bias_row == kBa ? filter.tau_a_s : filter.tau_g_s) == tau_s;
    });
  }

  void add_triad(const TriadErrorModel& triad, int bias_row, const Eigen::Vector3d& known_bias) {
    const auto of_triad = [&](ErrorSource accelerometer,
                              ErrorSource gyro) -> SourceCovariance<kFilters, kParameters>& {
      return of(bias_row == kBa ? accelerometer : gyro);
    };
    ProcessNoise& noise = of_triad(ErrorSource::kAccelerometerNoise, ErrorSource::kGyroNoise).noise;
    (bias_row == kBa ? noise.velocity_m2_per_s3 : noise.attitude_rad2_per_s) +=
        triad.noise_density * triad.noise_density;
    MarkovStart turn_on;
    turn_on.variance.setConstant(triad.bias_sigma * triad.bias_sigma);
    turn_on.mean = triad.bias;
    turn_on.known = known_bias;
    add_turn_on(turn_on, bias_row,
                of_triad(ErrorSource::kAccelerometerBias, ErrorSource::kGyroBias));
    if (triad.in_run.sigma == 0.0) return;
    add_drift(triad.in_run, bias_row,
              of_triad(ErrorSource::kAccelerometerDrift, ErrorSource::kGyroDrift));
  }

  void add_turn_on(const MarkovStart& turn_on, int bias_row,
                   SourceCovariance<kFilters, kParameters>& bias) {
    if (all_take_bias_for(std::numeric_limits<double>::infinity(), bias_row)) {
      // The states are as constant as the bias: nothing else need be remembered.
      bias.add_shared(bias_row, turn_on.error_moment());
    } else if (!turn_on.variance.isZero(0.0) || !turn_on.mean.isZero(0.0) ||
               !turn_on.known.isZero(0.0)) {
      bias.add_process({bias_row, GaussMarkov{}}, turn_on);
    }
  }

  void add_drift(const GaussMarkov& in_run, int bias_row,
                 SourceCovariance<kFilters, kParameters>& drift) {
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

  std::array<ProcessNoise, kFilters> filters_;
  bool by_source_;
  /// One for all, or one each.
  std::vector<std::pair<ErrorSource, SourceCovariance<kFilters, kParameters>>> sources_{};
  std::shared_ptr<const ParameterMoments> parameter_moments_;
  ParameterMoment all_moments_{ParameterMoment::Zero()};
  ParameterSources<kFilters, kParameters> parameters_{};
};

}  // namespace leeway::sim
