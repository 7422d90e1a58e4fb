/// @file
/// Odometer: the reading, how its log is called and spelled, and what it says of the state.
#pragma once

#include <Eigen/Core>

#include "leeway/earth/time.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/model/vehicle_state.hpp"
#include "leeway/navigator/vehicle_aiding.hpp"

namespace leeway {

/// Speed of the driven or rolling rear wheels: forwards positive, backwards negative.
struct OdometerSpeed {
  Time time{};
  double speed_mps{};
  double sigma_mps{0.1};  ///< beyond a constant scale error, which is estimated

  static constexpr const char* kName = "odometer";
  static constexpr const char* kLog = "speed log";
  static constexpr const char* kColumns[] = {"speed_mps", "sigma_mps"};
  static constexpr double kLargest = 500.0;  ///< of the speed's magnitude and of the sigma
  static constexpr bool VehicleConfig::*kIsOn = &VehicleConfig::odometer;
};

/// The rear axle's forward speed, times (1 + scale). 1 row. Source: Groves (2013) section 16.1.2.
/// @param omega_ib_b_radps  measured angular rate (bias not yet removed)
Measurement measurement(const OdometerSpeed& odometer, const Estimate& estimate,
                        const VehicleVector& vehicle, const Eigen::Vector3d& omega_ib_b_radps);

}  // namespace leeway
