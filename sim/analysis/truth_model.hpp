/// @file
/// All the sources of a scene's error together. Part of covariance_analysis.
#pragma once

#include <utility>
#include <vector>

#include "leeway/model/process_noise.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "sim/analysis/source_covariance.hpp"

namespace leeway::sim {

class TruthModel {
 public:
  /// E[p p^T] of the parameters of each source that has any.
  using ParameterMoment = Eigen::Matrix<double, kSensorParameters, kSensorParameters>;
  using ParameterMoments = std::vector<std::pair<ErrorSource, ParameterMoment>>;
  static ParameterMoments parameter_moments(const ImuErrorModel& imu);

  /// @param by_source  keeps the sources apart; else they share one covariance
  TruthModel(const Scene& scene, const ErrorMatrix& initial_nav, const ProcessNoise& filter,
             bool by_source);

  /// Whether a track must carry the sensors' matrices.
  static bool needs_parameters(const ImuErrorModel& imu) { return !parameter_moments(imu).empty(); }

  /// Whether the filter knows everything that goes on: its own covariance is then the true one.
  bool is_known_to(const ErrorMatrix& filter_P, const ProcessNoise& filter,
                   const Eigen::Matrix<double, 6, 1>& filter_fix_variance) const;

  void propagate(const Leg& leg);
  void update(const ScalarGain& gain);
  ErrorMatrix covariance() const;
  ErrorBudget budget(const Eigen::Matrix3d& C_en) const;

 private:
  void add_triad(const TriadErrorModel& triad, int bias_row, const Eigen::Vector3d& known_bias,
                 double filter_tau_s);
  static void add_drift(const GaussMarkov& in_run, int bias_row, SourceCovariance& drift,
                        double filter_tau_s);
  SourceCovariance& of(ErrorSource source);

  bool by_source_;
  std::vector<std::pair<ErrorSource, SourceCovariance>> sources_{};  // one for all, or one each
  ParameterMoments parameter_moments_;
  ParameterSources parameters_{};
};

}  // namespace leeway::sim
