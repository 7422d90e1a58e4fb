#include "leeway/sensors/vehicle_sensors.hpp"

#include <cmath>

#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

bool is_usable(const OdometerSpeed& odometer) {
  constexpr double kFastestMps = 500.0;
  return std::abs(odometer.speed_mps) <= kFastestMps && odometer.sigma_mps >= kLeastSigma &&
         odometer.sigma_mps <= kFastestMps;
}

bool is_usable(const BarometricHeight& barometer) {
  constexpr double kFurthestM = 1e5;
  return std::abs(barometer.height_m) <= kFurthestM && barometer.sigma_m >= kLeastSigma &&
         barometer.sigma_m <= kFurthestM;
}

}  // namespace leeway
