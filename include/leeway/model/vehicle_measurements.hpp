/// @file
/// What a road vehicle's motion and its simple sensors say, as measurements of the filter.
/// Groves (2013) sections 15.3 (constraints) and 16.1.2 (odometer), signs by error_state.hpp; each
/// Jacobian against central differences in the tests.
#pragma once

#include <Eigen/Core>

#include "leeway/model/error_state.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/model/vehicle_state.hpp"

namespace leeway {

/// Velocity of the rear axle over ground, vehicle axes (forward, right, down), for an estimate.
/// @param omega_ib_b_radps  measured angular rate (bias not yet removed)
Eigen::Vector3d rear_axle_velocity(const Estimate& estimate, const VehicleVector& vehicle,
                                   const Eigen::Vector3d& omega_ib_b_radps);

/// The rear axle moves along the vehicle's forward axis: no velocity to the right, none down.
/// 2 rows. Source: Groves (2013) (15.20).
Measurement non_holonomic(const Estimate& estimate, const VehicleVector& vehicle,
                          const Eigen::Vector3d& omega_ib_b_radps, double sigma_right_mps,
                          double sigma_down_mps);

/// The rear axle's forward speed, backwards negative, times (1 + scale). 1 row.
Measurement odometer_speed(double speed_mps, double sigma_mps, const Estimate& estimate,
                           const VehicleVector& vehicle, const Eigen::Vector3d& omega_ib_b_radps);

/// No velocity relative to the Earth. 3 rows, ECEF. Source: Groves (2013) (15.13).
Measurement zero_velocity(const Estimate& estimate, double sigma_mps);

/// No rotation relative to the Earth. 3 rows, body axes. Source: Groves (2013) (15.16).
/// @param mean_omega_ib_b_radps  measured rate, the mean of a while at rest
Measurement zero_angular_rate(const Estimate& estimate,
                              const Eigen::Vector3d& mean_omega_ib_b_radps, double sigma_radps);

/// Height of the IMU above the ellipsoid plus an offset. 1 row.
Measurement barometric_height(double height_m, double sigma_m, const Estimate& estimate,
                              const VehicleVector& vehicle);

}  // namespace leeway
