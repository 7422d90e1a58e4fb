/// @file
/// A linearized measurement of any kind, as the filter fuses it.
#pragma once

#include <Eigen/Core>

#include "leeway/model/error_state.hpp"
#include "leeway/model/vehicle_state.hpp"

namespace leeway {

/// A matrix over the components of a measurement, at most 6 x 6, in fixed storage.
using MeasurementMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

/// A measurement innovation = H x + H_vehicle y + noise of covariance R, with one row per
/// component, at most 6, in fixed storage. x is the error state, y the error of the vehicle's
/// parameters.
struct Measurement {
  explicit Measurement(int rows)
      : innovation(rows), H(rows, kErrorStates), H_vehicle(rows, kVehicleStates), R(rows, rows) {
    innovation.setZero();
    H.setZero();
    H_vehicle.setZero();
    R.setZero();
  }

  int rows() const { return static_cast<int>(innovation.size()); }

  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> innovation;
  Eigen::Matrix<double, Eigen::Dynamic, kErrorStates, 0, 6, kErrorStates> H;
  Eigen::Matrix<double, Eigen::Dynamic, kVehicleStates, 0, 6, kVehicleStates> H_vehicle;
  MeasurementMatrix R;
};

}  // namespace leeway
