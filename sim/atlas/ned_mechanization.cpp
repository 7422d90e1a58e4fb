#include "sim/atlas/ned_mechanization.hpp"

#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway::sim {
namespace {

/// Radii of curvature with the height added, along the meridian and across it.
struct Radii {
  double meridian_m;
  double transverse_m;
};

Radii radii(const Geodetic& position) {
  const double s = std::sin(position.lat_rad);
  const double w_sq = 1.0 - wgs84::kEccentricitySq * s * s;
  const double transverse_m = wgs84::kSemiMajorAxisM / std::sqrt(w_sq);
  return {transverse_m * (1.0 - wgs84::kEccentricitySq) / w_sq + position.height_m,
          transverse_m + position.height_m};
}

/// Rotation of the north-east-down axes over the Earth.
Eigen::Vector3d transport_rate_n(const Geodetic& position, const Eigen::Vector3d& v_n_mps) {
  const Radii r = radii(position);
  return {v_n_mps.y() / r.transverse_m, -v_n_mps.x() / r.meridian_m,
          -v_n_mps.y() * std::tan(position.lat_rad) / r.transverse_m};
}

}  // namespace

NedMechanization::NedMechanization(const NavState& start) {
  const NavStateNed ned = ned_from_nav_state(start);
  position_ = ned.position;
  v_n_mps_ = ned.v_n_mps;
  C_nb_ = rotation_from_euler(ned.attitude);
}

void NedMechanization::push(const ImuIncrement& inc) {
  const double dt_s = inc.dt_s;
  const double lat_rad = position_.lat_rad;
  const Eigen::Vector3d omega_ie_n =
      wgs84::kRotationRateRadps * Eigen::Vector3d(std::cos(lat_rad), 0.0, -std::sin(lat_rad));
  const Eigen::Vector3d omega_en_n = transport_rate_n(position_, v_n_mps_);
  const Eigen::Vector3d g_n =
      ned_to_ecef(position_).transpose() * gravity_e<GravityModel::kNormal>(r_e_m());
  const Eigen::Matrix3d turned = exp_rotation(-dt_s * (omega_ie_n + omega_en_n));
  const Eigen::Vector3d dv_f_n =
      0.5 * (C_nb_ + turned * C_nb_) * left_jacobian_times(inc.dtheta_b_rad, inc.dv_b_mps);
  const auto change = [&](const Eigen::Vector3d& v_n) -> Eigen::Vector3d {
    return dv_f_n + dt_s * (g_n - (2.0 * omega_ie_n + omega_en_n).cross(v_n));
  };
  const Eigen::Vector3d v_mid_n = v_n_mps_ + 0.5 * change(v_n_mps_);
  const Radii r = radii(position_);
  v_n_mps_ += change(v_mid_n);
  C_nb_ = turned * C_nb_ * exp_rotation(inc.dtheta_b_rad);
  position_.lat_rad += dt_s * v_mid_n.x() / r.meridian_m;
  position_.lon_rad += dt_s * v_mid_n.y() / (r.transverse_m * std::cos(lat_rad));
  position_.height_m -= dt_s * v_mid_n.z();
}

void NedMechanization::correct(const Geodetic& position, double share) {
  position_.lat_rad += share * (position.lat_rad - position_.lat_rad);
  position_.lon_rad += share * (position.lon_rad - position_.lon_rad);
}

}  // namespace leeway::sim
