#include "leeway/model/heading.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"

namespace leeway {

Azimuth::Azimuth(const Eigen::Vector3d& forward_e, const Eigen::Vector3d& r_e_m)
    : Azimuth(forward_e, ned_to_ecef(geodetic_from_ecef(r_e_m))) {}

Azimuth::Azimuth(const Eigen::Vector3d& forward_e, const Eigen::Matrix3d& C_en) {
  const double north = C_en.col(0).dot(forward_e);
  const double east = C_en.col(1).dot(forward_e);
  level_part = std::hypot(north, east);
  if (level_part == 0.0) return;
  angle_rad = std::atan2(east, north);
  gradient_e = (north * C_en.col(1) - east * C_en.col(0)) / (level_part * level_part);
}

double heading_variance_rad2(const Estimate& estimate, const ErrorMatrix& P) {
  const Eigen::Vector3d down_e = down_e_at(estimate.nav.r_e_m);
  return down_e.dot(P.block<3, 3>(kPsi, kPsi) * down_e);
}

double heading_sigma_rad(const Estimate& estimate, const ErrorMatrix& P) {
  return std::sqrt(std::max(0.0, heading_variance_rad2(estimate, P)));
}

bool rest_hides_heading(const ImuErrorModel& imu, const Estimate& estimate, const ErrorMatrix& P) {
  const double bias_radps = std::hypot(imu.gyro.bias_sigma, imu.gyro.in_run.sigma);
  const Eigen::Vector3d down_e = down_e_at(estimate.nav.r_e_m);
  const double level_rate_radps = earth_rotation_e_radps().cross(down_e).norm();
  return bias_radps > level_rate_radps * heading_sigma_rad(estimate, P);
}

}  // namespace leeway
