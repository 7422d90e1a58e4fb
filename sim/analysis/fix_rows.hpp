/// @file
/// A GNSS fix as linear analyses take it: six rows in units of what the filter takes for its noise.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "leeway/model/error_state.hpp"
#include "leeway/sim/sensors/gnss_simulator.hpp"

namespace leeway::sim {

/// What a row of a measurement is of. Those of a fix come first: position north, east, down, then
/// velocity.
enum RowKind : int {
  kExactRow = 6,  ///< a constraint that holds exactly
  kRateRow,       ///< the rate at rest, a second's mean
  kOdometerRow,
  kBarometerRow,
  kHeadingRow,
  kRowKinds,
};

/// Variances of what the sensors really err by, by RowKind, each in its unit's square.
using RowVariances = Eigen::Matrix<double, kRowKinds, 1>;

/// Rows are north, east, down of the position, then of the velocity.
/// innovation = H x + per_sigma * (error of the receiver).
struct FixRows {
  Eigen::Matrix<double, 6, kErrorStates> H{Eigen::Matrix<double, 6, kErrorStates>::Zero()};
  Eigen::Matrix<double, 6, 1> per_sigma{Eigen::Matrix<double, 6, 1>::Zero()};
  double fixes{1.0};  ///< whose mean this is: what is white averages out

  /// So many of these fixes as one.
  void repeat(double times) {
    H *= std::sqrt(times);
    per_sigma *= std::sqrt(times);
    fixes *= times;
  }
};

/// Variances of a fix by row, as the receiver reports them, m^2 and m^2/s^2.
Eigen::Matrix<double, 6, 1> fix_variance(const GnssErrorModel& errors);

/// The rows of a fix in a state of the vehicle.
/// @param lever_arm_b_m  IMU to antenna
/// @param weight         of the position, by gnss_position_weight()
FixRows fix_rows(const NavState& nav, const Eigen::Vector3d& omega_ib_b_radps,
                 const Eigen::Vector3d& lever_arm_b_m, const GnssErrorModel& errors, double weight);

}  // namespace leeway::sim
