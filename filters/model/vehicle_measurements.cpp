#include "leeway/model/vehicle_measurements.hpp"

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway {
namespace {

Eigen::Matrix3d vehicle_from_body(const VehicleVector& vehicle) {
  return exp_rotation({0.0, vehicle(kMountPitch), vehicle(kMountYaw)}).transpose();
}

}  // namespace

RearAxle::RearAxle(const Estimate& estimate, const VehicleVector& vehicle,
                   const Eigen::Vector3d& omega_ib_b_radps) {
  const Eigen::Matrix3d C_be = estimate.nav.q_eb.toRotationMatrix().transpose();
  const Eigen::Matrix3d C_vb = vehicle_from_body(vehicle);
  const Eigen::Vector3d axle_b(vehicle(kRearAxleX), 0.0, 0.0);
  const Eigen::Vector3d omega_eb_b =
      omega_ib_b_radps - estimate.bias.b_g_radps - C_be * earth_rotation_e_radps();
  const Eigen::Vector3d v_b = C_be * estimate.nav.v_e_mps + omega_eb_b.cross(axle_b);
  v_mps = C_vb * v_b;

  H.middleCols<3>(kPsi) = C_vb * C_be * skew(estimate.nav.v_e_mps) +
                          C_vb * skew(axle_b) * C_be * skew(earth_rotation_e_radps());
  H.middleCols<3>(kDv) = C_vb * C_be;
  H.middleCols<3>(kBg) = C_vb * skew(axle_b);
  // exp(-[(m + dm) x]) v_b, the mount's turn being small.
  const Eigen::Matrix3d by_mount = C_vb * skew(v_b);
  H_vehicle.col(kMountPitch) = by_mount.col(1);
  H_vehicle.col(kMountYaw) = by_mount.col(2);
  H_vehicle.col(kRearAxleX) = C_vb * omega_eb_b.cross(Eigen::Vector3d::UnitX());
}

Measurement non_holonomic(const Estimate& estimate, const VehicleVector& vehicle,
                          const Eigen::Vector3d& omega_ib_b_radps, double sigma_right_mps,
                          double sigma_down_mps) {
  const RearAxle axle(estimate, vehicle, omega_ib_b_radps);
  Measurement m(2);
  m.innovation = -axle.v_mps.tail<2>();
  m.H = axle.H.bottomRows<2>();
  m.H_vehicle = axle.H_vehicle.bottomRows<2>();
  m.R(0, 0) = sigma_right_mps * sigma_right_mps;
  m.R(1, 1) = sigma_down_mps * sigma_down_mps;
  return m;
}

Measurement zero_velocity(const Estimate& estimate, double sigma_mps) {
  Measurement m(3);
  m.innovation = -estimate.nav.v_e_mps;
  m.H.middleCols<3>(kDv).setIdentity();
  m.R.diagonal().setConstant(sigma_mps * sigma_mps);
  return m;
}

Measurement zero_angular_rate(const Estimate& estimate,
                              const Eigen::Vector3d& mean_omega_ib_b_radps, double sigma_radps) {
  const Eigen::Matrix3d C_be = estimate.nav.q_eb.toRotationMatrix().transpose();
  Measurement m(3);
  m.innovation = mean_omega_ib_b_radps - estimate.bias.b_g_radps - C_be * earth_rotation_e_radps();
  m.H.middleCols<3>(kPsi) = C_be * skew(earth_rotation_e_radps());
  m.H.middleCols<3>(kBg).setIdentity();
  m.R.diagonal().setConstant(sigma_radps * sigma_radps);
  return m;
}

}  // namespace leeway
