/// @file
/// What the Earth does to a step, common to all schemes: its rate, Coriolis and gravity. Private to
/// the strapdown.
#pragma once

#include <Eigen/Core>

#include "leeway/strapdown/strapdown.hpp"
#include "lib/earth/triple.hpp"
#include "lib/earth/zonal_gravity.hpp"

namespace leeway::schemes {

/// The Earth's rate as the attitude sees it, and as Coriolis does: about z in ECEF.
template <EarthRotation rotation>
constexpr double kTurnRadps =
    rotation == EarthRotation::kOn || rotation == EarthRotation::kTurnAlone
        ? wgs84::kRotationRateRadps
        : 0.0;
template <EarthRotation rotation>
constexpr double kCoriolisRadps =
    rotation == EarthRotation::kOn || rotation == EarthRotation::kCoriolisAlone
        ? wgs84::kRotationRateRadps
        : 0.0;

inline Eigen::Vector3d about_z_e(double rate) { return {0.0, 0.0, rate}; }

/// gravity_e() in line.
template <GravityModel gravity>
[[gnu::always_inline]] inline Triple gravity_of(const Triple& r_e_m) {
  if constexpr (gravity == GravityModel::kNormal) {
    return zonal::gravity_e<zonal::kNormalDegree>(r_e_m);
  } else if constexpr (gravity == GravityModel::kJ2) {
    return zonal::gravity_e<zonal::kJ2Degree>(r_e_m);
  } else {
    return triple(gravity_e<gravity>(vector(r_e_m)));
  }
}

/// omega x v for omega = (0, 0, rate).
[[gnu::always_inline]] inline Triple turn_about_z(double rate, const Triple& v) {
  return {-rate * v.y, rate * v.x, 0.0};
}

/// Second order in everything but the body-frame integrals, which the caller supplies in dv_f.
template <GravityModel gravity, EarthRotation rotation>
[[gnu::always_inline]] inline Triple velocity_change(const Triple& r_e_m, const Triple& v_e_mps,
                                                     const Triple& dv_f_e_mps, double dt_s) {
  constexpr double kOmega = kCoriolisRadps<rotation>;
  const Triple pushed = dv_f_e_mps + dt_s * gravity_of<gravity>(r_e_m + 0.5 * dt_s * v_e_mps);
  const Triple v_mid = v_e_mps + 0.5 * (pushed - turn_about_z(2.0 * dt_s * kOmega, v_e_mps));
  return pushed - turn_about_z(2.0 * dt_s * kOmega, v_mid);
}

}  // namespace leeway::schemes
