#include "leeway/navigator/barometer.hpp"

#include "leeway/earth/earth.hpp"

namespace leeway {

Measurement measurement(const BarometricHeight& barometer, const Estimate& estimate,
                        const VehicleVector& vehicle, const Eigen::Vector3d& /*omega_ib_b*/) {
  const Geodetic place = geodetic_from_ecef(estimate.nav.r_e_m);
  Measurement m(1);
  m.innovation(0) = barometer.height_m - place.height_m - vehicle(kHeightOffset);
  m.H.middleCols<3>(kDr) = -ned_to_ecef(place).col(2).transpose();
  m.H_vehicle(0, kHeightOffset) = 1.0;
  m.R(0, 0) = barometer.sigma_m * barometer.sigma_m;
  return m;
}

}  // namespace leeway
