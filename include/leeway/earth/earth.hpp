/// @file
/// The Earth: WGS-84 ellipsoid, geodetic coordinates, the north-east-down frame, gravity.
/// Gravity is always the force felt at rest on the turning Earth (gravitation plus centrifugal).
#pragma once

#include <Eigen/Core>

#include "leeway/earth/names.hpp"

namespace leeway {

/// WGS-84 defining parameters: NGA.STND.0036 (2014), table 3.1.
namespace wgs84 {
inline constexpr double kSemiMajorAxisM = 6378137.0;
inline constexpr double kFlattening = 1.0 / 298.257223563;
inline constexpr double kGmM3PerS2 = 3.986004418e14;
inline constexpr double kRotationRateRadps = 7.292115e-5;
inline constexpr double kEccentricitySq = kFlattening * (2.0 - kFlattening);
inline constexpr double kSemiMinorAxisM = kSemiMajorAxisM * (1.0 - kFlattening);
}  // namespace wgs84

/// 9.80665 m/s^2 exactly: the unit behind ug and mg, and the constant gravity model.
inline constexpr double kStandardGravityMps2 = 9.80665;

/// Earth rotation vector in ECEF, rad/s.
inline Eigen::Vector3d earth_rotation_e_radps() { return {0.0, 0.0, wgs84::kRotationRateRadps}; }

/// Latitude and longitude in radians, height above the WGS-84 ellipsoid in metres.
struct Geodetic {
  double lat_rad{};
  double lon_rad{};
  double height_m{};
};

/// ECEF coordinates (m) of a geodetic position; rounding error below 2e-9 m near the Earth.
/// Source: GeographicLib::Geocentric.
Eigen::Vector3d ecef_from_geodetic(const Geodetic& position);

/// Geodetic position of ECEF coordinates (m); longitude in [-pi, pi]. Error below 7e-9 m for
/// heights of -5000 km to 5000 km. Source: GeographicLib::Geocentric; Karney (2011), section 3.
Geodetic geodetic_from_ecef(const Eigen::Vector3d& r_e_m);

/// Rotation C_en from north-east-down to ECEF: its columns are north, east and down at the
/// position. At the poles north is the limit along the meridian of the given longitude.
Eigen::Matrix3d ned_to_ecef(const Geodetic& position);

/// Unit vector down at r_e (m), in ECEF: the last column of C_en.
Eigen::Vector3d down_e_at(const Eigen::Vector3d& r_e_m);

/// Model of the Earth's gravity in a strapdown.
enum class GravityModel {
  kConstant,  ///< 9.80665 m/s^2 along the ellipsoid's normal; within 0.027 m/s^2 at height 0 and
              ///< 0.06 m/s^2 from -10 to 10 km
  kJ2,        ///< central term and J2; within 1.2e-4 m/s^2 (12 ug) from -10 km up
  kNormal,    ///< the exact normal field; within 1.5e-14 m/s^2, rounding included, from -10 km up
};
constexpr auto names(GravityModel) { return std::array{"constant", "j2", "normal"}; }

/// Gravity at r_e (m), in ECEF, m/s^2; its error is that of the model. @pre 6.3e6 < |r_e|.
/// The normal field is a zonal series to degree 12; the first term left out is below 1e-15 m/s^2.
/// Source: Heiskanen and Moritz, Physical Geodesy, (2-92).
template <GravityModel model>
Eigen::Vector3d gravity_e(const Eigen::Vector3d& r_e_m);

/// Gravity as above, by a model chosen at run time.
Eigen::Vector3d gravity_e(GravityModel model, const Eigen::Vector3d& r_e_m);

/// Gradient of the normal gravity in ECEF at r_e (m), 1/s^2: symmetric, relative error below 1e-8.
Eigen::Matrix3d gravity_gradient_e(const Eigen::Vector3d& r_e_m);

}  // namespace leeway
