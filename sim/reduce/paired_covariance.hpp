/// @file
/// The errors of two filters on the same sensors and fixes, as one covariance: what they differ by
/// is a part of it. Linear; both filters integrate the motion alike and differ in their gains and
/// in what they make of the biases. What makes a mean difference is not here.
#pragma once

#include <Eigen/Core>
#include <array>

#include "leeway/model/error_state.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/sim/analysis/error_track.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// Six rows of a fix, whitened by what the filter takes for its noise: north, east, down of
/// position, then of velocity. innovation = H x + (error of the receiver) * per_sigma.
struct FixRows {
  Eigen::Matrix<double, 6, kErrorStates> H{Eigen::Matrix<double, 6, kErrorStates>::Zero()};
  Eigen::Matrix<double, 6, 1> per_sigma{Eigen::Matrix<double, 6, 1>::Zero()};
};
using FixGain = Eigen::Matrix<double, kErrorStates, 6>;

class PairedCovariance {
 public:
  static constexpr int kFilters = 2;

  /// What the filters take the decay of their bias states to be.
  struct BiasTimes {
    double tau_a_s{};
    double tau_g_s{};
  };

  /// @param initial_nav  covariance of attitude, velocity and position at the start, of both
  PairedCovariance(const Scene& scene, const ErrorMatrix& initial_nav,
                   const std::array<BiasTimes, kFilters>& filters);

  /// @param leg  of a track whose biases do not decay
  void propagate(const Leg& leg);
  void update(const FixRows& fix, const std::array<FixGain, kFilters>& gains);

  /// E[x x^T] of the error of a filter.
  ErrorMatrix of(int filter) const;

  /// E[d d^T] of what the errors differ by.
  ErrorMatrix difference() const;

  /// What parameters of the sensors with this E[p p^T] make of the error of a filter.
  using ParameterMoment = Eigen::Matrix<double, kSensorParameters, kSensorParameters>;
  ErrorMatrix of_parameters(int filter, const ParameterMoment& moment) const;

 private:
  // Both errors, the turn-on and the in-run biases of both triads, the slow error of the receiver.
  static constexpr int kTurnOn = kFilters * kErrorStates;
  static constexpr int kInRun = kTurnOn + 6;
  static constexpr int kReceiver = kInRun + 6;
  static constexpr int kAll = kReceiver + 3;
  using Joint = Eigen::Matrix<double, kAll, kAll>;

  void start_triad(const TriadErrorModel& triad, const Eigen::Vector3d& known, int which);
  void step_biases(double dt_s);
  void step_triad(double dt_s, int which);
  void add_white_noise(double dt_s);
  void add_to_errors(int row, double variance);

  /// Z <- L Z L^T by an L that acts in place on rows.
  template <class Left>
  void transform(const Left& left) {
    left(Z_);
    Z_.transposeInPlace();
    left(Z_);
  }

  std::array<const TriadErrorModel*, 2> triads_;
  const GnssErrorModel* receiver_;
  std::array<BiasTimes, kFilters> filters_;
  Joint Z_{Joint::Zero()};
  ParameterMoment moment_{ParameterMoment::Zero()};
  bool has_parameters_;
  std::array<ParameterMatrix, kFilters> S_{ParameterMatrix::Zero(), ParameterMatrix::Zero()};
};

}  // namespace leeway::sim
