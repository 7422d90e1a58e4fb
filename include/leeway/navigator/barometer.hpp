/// @file
/// Barometer: the reading, how its log is called and spelled, and what it says of the state.
#pragma once

#include <Eigen/Core>

#include "leeway/earth/time.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/model/vehicle_state.hpp"
#include "leeway/navigator/vehicle_aiding.hpp"

namespace leeway {

/// Height from air pressure, by whatever atmosphere: a constant offset is estimated.
struct BarometricHeight {
  Time time{};
  double height_m{};
  double sigma_m{0.5};  ///< beyond the slow change of the weather

  static constexpr const char* kName = "barometer";
  static constexpr const char* kLog = "height log";
  static constexpr const char* kColumns[] = {"height_m", "sigma_m"};
  static constexpr double kLargest = 1e5;  ///< of the height's magnitude and of the sigma
  static constexpr bool VehicleConfig::*kIsOn = &VehicleConfig::barometer;
};

/// Height of the IMU above the ellipsoid plus an offset. 1 row. The rate is not used.
Measurement measurement(const BarometricHeight& barometer, const Estimate& estimate,
                        const VehicleVector& vehicle, const Eigen::Vector3d& omega_ib_b_radps);

}  // namespace leeway
