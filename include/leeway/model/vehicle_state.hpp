/// @file
/// The parameters of the vehicle that a filter may estimate beside the 15 error states: order, sign
/// and units.
///
///   mount_pitch, mount_yaw  rad   vehicle to body axes: C_bv = exp([(0, pitch, yaw) x])
///   rear_axle_x             m     IMU to the point without side slip, along the body's x axis
///   odometer_scale          1     odometer = (1 + scale) * speed
///   height_offset           m     barometric height = ellipsoidal height + offset
///
/// The roll of the mount is no parameter, because no constraint of the velocity shows it.
#pragma once

#include <Eigen/Core>

#include "leeway/model/error_state.hpp"

namespace leeway {

inline constexpr int kVehicleStates = 5;
inline constexpr int kMountPitch = 0;
inline constexpr int kMountYaw = 1;
inline constexpr int kRearAxleX = 2;
inline constexpr int kOdometerScale = 3;
inline constexpr int kHeightOffset = 4;

using VehicleVector = Eigen::Matrix<double, kVehicleStates, 1>;
using VehicleMatrix = Eigen::Matrix<double, kVehicleStates, kVehicleStates>;
using VehicleCross = Eigen::Matrix<double, kErrorStates, kVehicleStates>;

/// The joint state: the error state followed by the vehicle's parameters.
inline constexpr int kJointStates = kErrorStates + kVehicleStates;
using JointVector = Eigen::Matrix<double, kJointStates, 1>;
using JointMatrix = Eigen::Matrix<double, kJointStates, kJointStates>;

/// Estimates of the vehicle's parameters with their covariance. Their error is truth - estimate, as
/// for the error state.
struct VehicleState {
  VehicleVector value{VehicleVector::Zero()};
  VehicleMatrix P{VehicleMatrix::Zero()};
  VehicleCross cross{VehicleCross::Zero()};  ///< covariance of the 15 errors with the parameters'
  VehicleVector random_walk_per_s{VehicleVector::Zero()};  ///< growth of the diagonal of P
};

}  // namespace leeway
