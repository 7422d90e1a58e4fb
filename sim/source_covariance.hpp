/// @file
/// The covariance of a filter's error as it comes from one source, under the gains of a filter that
/// does not know the source. Part of covariance_analysis.
#pragma once

#include <Eigen/Core>

#include "leeway/filters/covariance.hpp"
#include "leeway/filters/error_state.hpp"
#include "leeway/sim/error_track.hpp"

namespace leeway::sim {

/// One scalar measurement of a fix, whitened by what the filter takes its noise to be:
/// innovation = h x + (error of the receiver) / sigma.
struct ScalarGain {
  ErrorVector K{ErrorVector::Zero()};
  ErrorVector h{ErrorVector::Zero()};
  int axis{};             ///< north, east, down of position, then of velocity
  double per_sigma{1.0};  ///< 1 / sigma
};

/// White noise and initial errors: sources that leave no memory but the error itself.
class WhiteSource {
 public:
  ErrorMatrix P{ErrorMatrix::Zero()};
  ProcessNoise noise{};
  Eigen::Matrix<double, 6, 1> fix_variance{Eigen::Matrix<double, 6, 1>::Zero()};  ///< by axis

  void propagate(const Leg& leg);
  void update(const ScalarGain& gain);
};

/// A Gauss-Markov process g of three axes, or a constant (tau infinite), that enters through a bias
/// state or through the position fixes. The filter's state decays by its own time constant.
class MarkovSource {
 public:
  static constexpr int kFixes = -1;

  /// How g starts: a mean, of which the filter may know some, and a variance.
  struct Start {
    Eigen::Vector3d variance{Eigen::Vector3d::Zero()};
    Eigen::Vector3d mean{Eigen::Vector3d::Zero()};
    Eigen::Vector3d known{Eigen::Vector3d::Zero()};
  };

  /// @param enters_at  kBa, kBg or kFixes
  /// @param process  of g; infinite tau: a constant
  MarkovSource(int enters_at, const Start& start, const GaussMarkov& process, double filter_tau_s);

  void propagate(const Leg& leg);
  void update(const ScalarGain& gain);
  ErrorMatrix covariance() const { return P_; }

 private:
  void step_process(double dt_s);

  int enters_at_;
  GaussMarkov process_;
  double filter_tau_s_;
  ErrorMatrix P_{ErrorMatrix::Zero()};
  Eigen::Matrix<double, kErrorStates, 3> S_{Eigen::Matrix<double, kErrorStates, 3>::Zero()};
  Eigen::Matrix3d G_;  // E[g g^T]; S = E[error g^T]
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
