#include "leeway/model/gnss_measurement.hpp"

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway {

Eigen::Vector3d antenna_position_e(const Estimate& estimate, const Eigen::Vector3d& lever_arm_b_m) {
  return estimate.nav.r_e_m + estimate.nav.q_eb * lever_arm_b_m;
}

Eigen::Vector3d antenna_velocity_e(const Estimate& estimate, const Eigen::Vector3d& lever_arm_b_m,
                                   const Eigen::Vector3d& omega_ib_b_radps) {
  const Eigen::Vector3d omega_b = omega_ib_b_radps - estimate.bias.b_g_radps;
  const Eigen::Vector3d lever_e = estimate.nav.q_eb * lever_arm_b_m;
  return estimate.nav.v_e_mps + estimate.nav.q_eb * omega_b.cross(lever_arm_b_m) -
         earth_rotation_e_radps().cross(lever_e);
}

Measurement gnss_measurement(const GnssFix& fix, const Estimate& estimate,
                             const Eigen::Vector3d& lever_arm_b_m,
                             const Eigen::Vector3d& omega_ib_b_radps) {
  const int rows = (fix.position ? 3 : 0) + (fix.velocity ? 3 : 0);
  Measurement m(rows);
  const Eigen::Matrix3d C_eb = estimate.nav.q_eb.toRotationMatrix();
  const Eigen::Vector3d lever_e = C_eb * lever_arm_b_m;
  if (fix.position) {
    m.innovation.head<3>() = fix.position->r_e_m - antenna_position_e(estimate, lever_arm_b_m);
    m.H.block<3, 3>(0, kPsi) = -skew(lever_e);
    m.H.block<3, 3>(0, kDr).setIdentity();
    m.R.topLeftCorner<3, 3>() = fix.position->R_e_m2;
  }
  if (fix.velocity) {
    const int row = rows - 3;
    const Eigen::Vector3d omega_b = omega_ib_b_radps - estimate.bias.b_g_radps;
    m.innovation.tail<3>() =
        fix.velocity->v_e_mps - antenna_velocity_e(estimate, lever_arm_b_m, omega_ib_b_radps);
    m.H.block<3, 3>(row, kPsi) =
        skew(earth_rotation_e_radps()) * skew(lever_e) - skew(C_eb * omega_b.cross(lever_arm_b_m));
    m.H.block<3, 3>(row, kDv).setIdentity();
    m.H.block<3, 3>(row, kBg) = C_eb * skew(lever_arm_b_m);
    m.R.bottomRightCorner<3, 3>() = fix.velocity->R_e_m2ps2;
  }
  return m;
}

}  // namespace leeway
