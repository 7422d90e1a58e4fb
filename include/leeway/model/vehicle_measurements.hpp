/// @file
/// Measurements from the motion of a road vehicle and from its simple sensors, with the signs of
/// error_state.hpp. The tests compare each Jacobian with central differences.
/// Source: Groves (2013), sections 15.3 (constraints) and 16.1.2 (odometer).
#pragma once

#include <Eigen/Core>

#include "leeway/model/error_state.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/model/vehicle_state.hpp"

namespace leeway {

/// Velocity of the rear axle over ground, m/s, in vehicle axes (forward, right, down), for an
/// estimate.
/// @param omega_ib_b_radps  measured angular rate, bias not yet removed
Eigen::Vector3d rear_axle_velocity(const Estimate& estimate, const VehicleVector& vehicle,
                                   const Eigen::Vector3d& omega_ib_b_radps);

/// The non-holonomic constraint: the rear axle has no velocity to the right and none down. 2 rows,
/// vehicle axes. Source: Groves (2013) (15.20).
Measurement non_holonomic(const Estimate& estimate, const VehicleVector& vehicle,
                          const Eigen::Vector3d& omega_ib_b_radps, double sigma_right_mps,
                          double sigma_down_mps);

/// The odometer reading: (1 + scale) times the forward speed of the rear axle, negative backwards.
/// 1 row.
Measurement odometer_speed(double speed_mps, double sigma_mps, const Estimate& estimate,
                           const VehicleVector& vehicle, const Eigen::Vector3d& omega_ib_b_radps);

/// Zero velocity relative to the Earth. 3 rows, ECEF axes. Source: Groves (2013) (15.13).
Measurement zero_velocity(const Estimate& estimate, double sigma_mps);

/// Zero angular rate relative to the Earth. 3 rows, body axes. Source: Groves (2013) (15.16).
/// @param mean_omega_ib_b_radps  mean measured rate over a time at rest, bias not yet removed
Measurement zero_angular_rate(const Estimate& estimate,
                              const Eigen::Vector3d& mean_omega_ib_b_radps, double sigma_radps);

/// The barometer reading: height of the IMU above the ellipsoid plus an offset, m. 1 row.
Measurement barometric_height(double height_m, double sigma_m, const Estimate& estimate,
                              const VehicleVector& vehicle);

}  // namespace leeway
