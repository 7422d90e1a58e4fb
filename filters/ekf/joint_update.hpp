/// @file
/// Measurements taken into the error state together with the vehicle's parameters, or with some
/// directions held.
#pragma once

#include <Eigen/Core>

#include "leeway/ekf/belief.hpp"
#include "leeway/ekf/update_outcome.hpp"
#include "leeway/model/measurement.hpp"

namespace leeway {

/// Measurement whose components are independent and of unit variance.
struct WhiteMeasurement {
  decltype(Measurement::H) H;
  decltype(Measurement::H_vehicle) H_vehicle;
  decltype(Measurement::innovation) z;
};

/// The measurement by the Cholesky factor of R, some of its rows times a weight.
/// @param weighted_rows  how many rows, the first ones: those of a position
/// @param with_vehicle   whether H_vehicle is wanted; else it is left empty
WhiteMeasurement whitened(const Measurement& m, int weighted_rows, double weight,
                          bool with_vehicle);

/// S = H P H^T + R, with the vehicle's part where there is one.
MeasurementMatrix innovation_covariance(const Measurement& m, const ErrorMatrix& P,
                                        const VehicleState* vehicle);

/// Takes the measurement into P and the vehicle's parameters; the estimate is the caller's.
/// @returns the correction of the error state
ErrorVector update_jointly(Belief& belief, const WhiteMeasurement& m, Held held);

}  // namespace leeway
