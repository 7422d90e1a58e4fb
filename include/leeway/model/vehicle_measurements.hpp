/// @file
/// What a road vehicle's motion says, as measurements of the filter. Groves (2013) section 15.3,
/// signs by error_state.hpp; each Jacobian against central differences in the tests.
#pragma once

#include <Eigen/Core>

#include "leeway/model/error_state.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/model/vehicle_state.hpp"

namespace leeway {

/// Velocity of the rear axle over ground for an estimate, vehicle axes (forward, right, down), and
/// its derivatives, one row per axis.
struct RearAxle {
  /// @param omega_ib_b_radps  measured angular rate (bias not yet removed)
  RearAxle(const Estimate& estimate, const VehicleVector& vehicle,
           const Eigen::Vector3d& omega_ib_b_radps);

  Eigen::Vector3d v_mps;
  Eigen::Matrix<double, 3, kErrorStates> H{Eigen::Matrix<double, 3, kErrorStates>::Zero()};
  Eigen::Matrix<double, 3, kVehicleStates> H_vehicle{
      Eigen::Matrix<double, 3, kVehicleStates>::Zero()};
};

/// The rear axle moves along the vehicle's forward axis: no velocity to the right, none down.
/// 2 rows. Source: Groves (2013) (15.20).
Measurement non_holonomic(const Estimate& estimate, const VehicleVector& vehicle,
                          const Eigen::Vector3d& omega_ib_b_radps, double sigma_right_mps,
                          double sigma_down_mps);

/// No velocity relative to the Earth. 3 rows, ECEF. Source: Groves (2013) (15.13).
Measurement zero_velocity(const Estimate& estimate, double sigma_mps);

/// No rotation relative to the Earth. 3 rows, body axes. Source: Groves (2013) (15.16).
/// @param mean_omega_ib_b_radps  measured rate, the mean of a while at rest
Measurement zero_angular_rate(const Estimate& estimate,
                              const Eigen::Vector3d& mean_omega_ib_b_radps, double sigma_radps);

}  // namespace leeway
