/// @file
/// The heading in an estimate: how well it is known, and whether a standstill can tell it.
#pragma once

#include "leeway/model/error_state.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway {

/// Variance of a turn about the local vertical: of the heading, rad^2.
double heading_variance_rad2(const Estimate& estimate, const ErrorMatrix& P);

/// 1 sigma of the same; 0 where the variance is negative.
double heading_sigma_rad(const Estimate& estimate, const ErrorMatrix& P);

/// Whether a standstill cannot tell the heading better than it is known: the rate of the Earth that
/// would tell it is hidden in the gyro's bias.
bool rest_hides_heading(const ImuErrorModel& imu, const Estimate& estimate, const ErrorMatrix& P);

}  // namespace leeway
