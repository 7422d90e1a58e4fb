/// @file
/// Odometer: the reading, the words and columns of its log, and what it says of the state.
#pragma once

#include <Eigen/Core>

#include "leeway/model/vehicle_measurements.hpp"
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
  static constexpr double kUnit = 1.0;       ///< of the columns, in SI
  static constexpr double kLargest = 500.0;  ///< of the speed's magnitude and of the sigma
  static constexpr bool VehicleConfig::*kIsOn = &VehicleConfig::odometer;
};

/// The rear axle's forward speed times (1 + scale). 1 row. Source: Groves (2013) section 16.1.2.
/// @param omega_ib_b_radps  measured angular rate (bias not yet removed)
inline Measurement measurement(const OdometerSpeed& odometer, const Estimate& estimate,
                               const VehicleVector& vehicle,
                               const Eigen::Vector3d& omega_ib_b_radps) {
  const RearAxle axle(estimate, vehicle, omega_ib_b_radps);
  const double scale = 1.0 + vehicle(kOdometerScale);
  Measurement m(1);
  m.innovation(0) = odometer.speed_mps - scale * axle.v_mps.x();
  m.H = scale * axle.H.topRows<1>();
  m.H_vehicle = scale * axle.H_vehicle.topRows<1>();
  m.H_vehicle(0, kOdometerScale) = axle.v_mps.x();
  m.R(0, 0) = odometer.sigma_mps * odometer.sigma_mps;
  return m;
}

}  // namespace leeway
