#include "sim/analysis/fix_rows.hpp"

#include "leeway/earth/earth.hpp"
#include "leeway/model/gnss_measurement.hpp"

namespace leeway::sim {

Eigen::Matrix<double, 6, 1> fix_variance(const GnssErrorModel& errors) {
  Eigen::Matrix<double, 6, 1> variance;
  variance.head<3>() =
      errors.position_sigma_n_m.cwiseAbs2() + errors.correlated_sigma_n_m.cwiseAbs2();
  variance.tail<3>() = errors.velocity_sigma_n_mps.cwiseAbs2();
  return variance;
}

FixRows fix_rows(const NavState& nav, const Eigen::Vector3d& omega_ib_b_radps,
                 const Eigen::Vector3d& lever_arm_b_m, const GnssErrorModel& errors,
                 double weight) {
  const GnssFix fix{nav.time, GnssPosition{}, GnssVelocity{}};
  const Measurement m = gnss_measurement(fix, {nav, {}}, lever_arm_b_m, omega_ib_b_radps);
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(nav.r_e_m)).transpose();
  FixRows rows;
  rows.per_sigma << Eigen::Vector3d::Constant(weight), Eigen::Vector3d::Ones();
  rows.per_sigma = rows.per_sigma.cwiseQuotient(fix_variance(errors).cwiseSqrt());
  for (int row = 0; row < 6; ++row) {
    rows.H.row(row) = C_ne.row(row % 3) * m.H.middleRows<3>(row < 3 ? 0 : 3);
  }
  rows.H = rows.per_sigma.asDiagonal() * rows.H;
  return rows;
}

}  // namespace leeway::sim
