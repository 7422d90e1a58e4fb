#include "leeway/vehicle_sensors.hpp"

#include <cmath>

namespace leeway {

bool is_usable(const OdometerSpeed& odometer) {
  constexpr double kFastestMps = 500.0;
  return std::abs(odometer.speed_mps) <= kFastestMps && odometer.sigma_mps > 0.0 &&
         odometer.sigma_mps <= kFastestMps;
}

bool is_usable(const BarometricHeight& barometer) {
  constexpr double kFurthestM = 1e5;
  return std::abs(barometer.height_m) <= kFurthestM && barometer.sigma_m > 0.0 &&
         barometer.sigma_m <= kFurthestM;
}

}  // namespace leeway
