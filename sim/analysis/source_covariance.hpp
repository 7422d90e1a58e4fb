/// @file
/// The covariance of a filter's error as it comes from some sources, under the gains of a filter
/// that need not know them. Part of covariance_analysis.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "leeway/covariance/covariance.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "leeway/sim/analysis/error_track.hpp"

namespace leeway::sim {

/// One scalar measurement of a fix, whitened by what the filter takes its noise to be:
/// innovation = h x + (error of the receiver) * per_sigma.
struct ScalarGain {
  ErrorVector K{ErrorVector::Zero()};
  ErrorVector h{ErrorVector::Zero()};
  int axis{};             ///< north, east, down of position, then of velocity
  double per_sigma{1.0};  ///< 1 / sigma
};

/// A Gauss-Markov process g of three axes, or a constant (tau infinite), that enters the error
/// through a bias state or through the position fixes, and is correlated with it.
struct MarkovSource {
  static constexpr int kFixes = -1;

  int enters_at{kFixes};  ///< kBa, kBg or kFixes
  GaussMarkov process{};
  double filter_tau_s{};  ///< by which the filter lets the bias state decay
  Eigen::Matrix<double, kErrorStates, 3> S{
      Eigen::Matrix<double, kErrorStates, 3>::Zero()};  ///< E[error g^T]
  Eigen::Matrix3d G{Eigen::Matrix3d::Zero()};           ///< E[g g^T]
};

/// How such a process starts: a mean, of which the filter may know some, and a variance.
struct MarkovStart {
  Eigen::Vector3d variance{Eigen::Vector3d::Zero()};
  Eigen::Vector3d mean{Eigen::Vector3d::Zero()};
  Eigen::Vector3d known{Eigen::Vector3d::Zero()};
};

/// E[x x^T] from initial errors and white noise, and from processes with a memory of their own.
class SourceCovariance {
 public:
  ErrorMatrix P{ErrorMatrix::Zero()};
  ProcessNoise noise{};
  Eigen::Matrix<double, 6, 1> fix_variance{Eigen::Matrix<double, 6, 1>::Zero()};  ///< by axis

  void add_process(MarkovSource source, const MarkovStart& start);
  bool has_processes() const { return !processes_.empty(); }

  void propagate(const Leg& leg);
  void update(const ScalarGain& gain);

 private:
  void step_process(MarkovSource& source, double dt_s);

  std::vector<MarkovSource> processes_{};
};

/// Unknown constants of the sensors: the error is linear in them. One sensitivity serves all.
class ParameterSources {
 public:
  void propagate(const Leg& leg);
  void update(const ScalarGain& gain);

  /// @param second_moment  E[p p^T] of the parameters that belong to the source
  ErrorMatrix covariance(
      const Eigen::Matrix<double, kSensorParameters, kSensorParameters>& second_moment) const;

 private:
  ParameterMatrix S_{ParameterMatrix::Zero()};
};

}  // namespace leeway::sim
