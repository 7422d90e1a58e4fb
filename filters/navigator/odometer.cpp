#include "leeway/navigator/odometer.hpp"

#include "leeway/model/vehicle_measurements.hpp"

namespace leeway {

Measurement measurement(const OdometerSpeed& odometer, const Estimate& estimate,
                        const VehicleVector& vehicle, const Eigen::Vector3d& omega_ib_b_radps) {
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
