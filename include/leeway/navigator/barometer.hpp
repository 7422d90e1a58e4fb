/// @file
/// Barometer: the reading, the words and columns of its log, and what it says of the state.
#pragma once

#include <Eigen/Core>

#include "leeway/earth/earth.hpp"
#include "leeway/model/measurement.hpp"
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
  static constexpr double kUnit = 1.0;     ///< of the columns, in SI
  static constexpr double kLargest = 1e5;  ///< of the height's magnitude and of the sigma
  static constexpr bool VehicleConfig::*kIsOn = &VehicleConfig::barometer;
};

/// Height of the IMU above the ellipsoid plus an offset. 1 row.
inline Measurement measurement(const BarometricHeight& barometer, const Estimate& estimate,
                               const VehicleVector& vehicle,
                               const Eigen::Vector3d& /*omega_ib_b_radps*/) {
  const Geodetic place = geodetic_from_ecef(estimate.nav.r_e_m);
  Measurement m(1);
  m.innovation(0) = barometer.height_m - place.height_m - vehicle(kHeightOffset);
  m.H.middleCols<3>(kDr) = -ned_to_ecef(place).col(2).transpose();
  m.H_vehicle(0, kHeightOffset) = 1.0;
  m.R(0, 0) = barometer.sigma_m * barometer.sigma_m;
  return m;
}

}  // namespace leeway
