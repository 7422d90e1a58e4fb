#include "leeway/earth/earth.hpp"

#include <GeographicLib/Geocentric.hpp>
#include <cmath>

#include "leeway/earth/rotation.hpp"
#include "lib/earth/triple.hpp"
#include "lib/earth/zonal_gravity.hpp"

namespace leeway {

Eigen::Vector3d ecef_from_geodetic(const Geodetic& position) {
  Eigen::Vector3d r_e_m;
  GeographicLib::Geocentric::WGS84().Forward(position.lat_rad / kRadPerDeg,
                                             position.lon_rad / kRadPerDeg, position.height_m,
                                             r_e_m.x(), r_e_m.y(), r_e_m.z());
  return r_e_m;
}

Geodetic geodetic_from_ecef(const Eigen::Vector3d& r_e_m) {
  Geodetic position;
  GeographicLib::Geocentric::WGS84().Reverse(r_e_m.x(), r_e_m.y(), r_e_m.z(), position.lat_rad,
                                             position.lon_rad, position.height_m);
  position.lat_rad *= kRadPerDeg;
  position.lon_rad *= kRadPerDeg;
  return position;
}

Eigen::Matrix3d ned_to_ecef(const Geodetic& position) {
  const double sin_lat = std::sin(position.lat_rad);
  const double cos_lat = std::cos(position.lat_rad);
  const double sin_lon = std::sin(position.lon_rad);
  const double cos_lon = std::cos(position.lon_rad);
  Eigen::Matrix3d C_en;
  C_en << -sin_lat * cos_lon, -sin_lon, -cos_lat * cos_lon,  //
      -sin_lat * sin_lon, cos_lon, -cos_lat * sin_lon,       //
      cos_lat, 0.0, -sin_lat;
  return C_en;
}

Eigen::Vector3d down_e_at(const Eigen::Vector3d& r_e_m) {
  return ned_to_ecef(geodetic_from_ecef(r_e_m)).col(2);
}

template <>
Eigen::Vector3d gravity_e<GravityModel::kConstant>(const Eigen::Vector3d& r_e_m) {
  const Eigen::Vector3d outward(r_e_m.x(), r_e_m.y(), r_e_m.z() / (1.0 - zonal::kE2));
  return -kStandardGravityMps2 * outward.normalized();
}

template <>
Eigen::Vector3d gravity_e<GravityModel::kJ2>(const Eigen::Vector3d& r_e_m) {
  return vector(zonal::gravity_e<zonal::kJ2Degree>(triple(r_e_m)));
}

template <>
Eigen::Vector3d gravity_e<GravityModel::kNormal>(const Eigen::Vector3d& r_e_m) {
  return vector(zonal::gravity_e<zonal::kNormalDegree>(triple(r_e_m)));
}

Eigen::Vector3d gravity_e(GravityModel model, const Eigen::Vector3d& r_e_m) {
  switch (model) {
    case GravityModel::kConstant:
      return gravity_e<GravityModel::kConstant>(r_e_m);
    case GravityModel::kJ2:
      return gravity_e<GravityModel::kJ2>(r_e_m);
    case GravityModel::kNormal:
      break;
  }
  return gravity_e<GravityModel::kNormal>(r_e_m);
}

Eigen::Matrix3d gravity_gradient_e(const Eigen::Vector3d& r_e_m) {
  // Degree 6 leaves 5e-10 relative; the gradient itself moves a position by 1e-6 of its error in 1
  // s.
  constexpr int kDegree = 6;
  static constexpr auto kEquatorial = zonal::equatorial_sum<kDegree>();
  static constexpr auto kEquatorialEquatorial = zonal::equatorial_equatorial_sum<kDegree>();
  static constexpr auto kAxialEquatorial = zonal::axial_equatorial_sum<kDegree>();
  static constexpr auto kAxialAxial = zonal::axial_axial_sum<kDegree>();
  const double inv_r_sq = 1.0 / r_e_m.squaredNorm();
  const double inv_r = std::sqrt(inv_r_sq);
  const double q = wgs84::kSemiMajorAxisM * wgs84::kSemiMajorAxisM * inv_r_sq;
  const Eigen::Vector3d u = r_e_m * inv_r;
  const double s_sq = u.z() * u.z();
  const double gm_over_r3 = wgs84::kGmM3PerS2 * inv_r_sq * inv_r;

  const double isotropic = -kEquatorial(q, s_sq);
  const double radial = kEquatorialEquatorial(q, s_sq);
  const double axial = kAxialEquatorial(q, s_sq) * u.z();
  Eigen::Matrix3d gradient;
  gradient(0, 0) =
      gm_over_r3 * (isotropic + radial * u.x() * u.x()) + zonal::kOmega * zonal::kOmega;
  gradient(1, 1) =
      gm_over_r3 * (isotropic + radial * u.y() * u.y()) + zonal::kOmega * zonal::kOmega;
  gradient(2, 2) = gm_over_r3 * kAxialAxial(q, s_sq);
  gradient(0, 1) = gradient(1, 0) = gm_over_r3 * radial * u.x() * u.y();
  gradient(0, 2) = gradient(2, 0) = gm_over_r3 * axial * u.x();
  gradient(1, 2) = gradient(2, 1) = gm_over_r3 * axial * u.y();
  return gradient;
}

}  // namespace leeway
