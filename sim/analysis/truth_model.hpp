/// @file
/// All the sources of a scene's error together, in one filter or in several. Part of
/// covariance_analysis.
#pragma once

#include <array>
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

template <int kFilters>
class TruthModel {
 public:
  /// @param initial_nav  covariance of attitude, velocity and position at the start, of all filters
  /// @param filters      what they take for the noise
  /// @param by_source    keeps the sources apart; else they share one covariance
  TruthModel(const Scene& scene, const ErrorMatrix& initial_nav,
             const std::array<ProcessNoise, kFilters>& filters, bool by_source);

  /// Whether the filter knows everything that goes on: its own covariance is then the true one.
  bool is_known_to(const ErrorMoment<kFilters>& filter_P,
                   const Eigen::Matrix<double, 6, 1>& filter_fix_variance) const;

  void propagate(const Leg& leg);
  /// @param gains  on the rows one after the other: each sees the errors that the last one left
  void update(const FixRows& fix, const FixGains<kFilters>& gains);
  ErrorMoment<kFilters> covariance() const;

  /// Of the first filter.
  ErrorBudget error_budget(const Eigen::Matrix3d& C_en) const;

 private:
  void add_triad(const TriadErrorModel& triad, int bias_row, const Eigen::Vector3d& known_bias);
  void add_turn_on(const MarkovStart& turn_on, int bias_row, SourceCovariance<kFilters>& bias);
  void add_drift(const GaussMarkov& in_run, int bias_row, SourceCovariance<kFilters>& drift);
  bool all_take_bias_for(double tau_s, int bias_row) const;
  SourceCovariance<kFilters>& of(ErrorSource source);

  std::array<ProcessNoise, kFilters> filters_;
  bool by_source_;
  /// One for all, or one each.
  std::vector<std::pair<ErrorSource, SourceCovariance<kFilters>>> sources_{};
  ParameterMoments parameter_moments_;
  ParameterSources<kFilters> parameters_{};
};

}  // namespace leeway::sim
