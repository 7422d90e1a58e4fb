/// @file
/// Rotations by the small angles of one increment: power series without a branch, division or root,
/// exact to rounding. rotation.hpp has the same for any angle.
#pragma once

#include "lib/earth/triple.hpp"

namespace leeway {

/// Below this squared angle, of 0.1 rad, the first terms left out are below 2e-16 of the result.
inline constexpr double kSmallTurnSq = 0.01;

/// left_jacobian_times() for |phi|^2 < kSmallTurnSq.
[[gnu::always_inline]] inline Triple small_left_jacobian_times(const Triple& phi_rad,
                                                               const Triple& v) {
  const double t = squared_norm(phi_rad);
  const double versine_ratio =
      1.0 / 2 + t * (-1.0 / 24 + t * (1.0 / 720 + t * (-1.0 / 40320 + t * (1.0 / 3628800))));
  const double sine_deficit_ratio =
      1.0 / 6 + t * (-1.0 / 120 + t * (1.0 / 5040 + t * (-1.0 / 362880)));
  const Triple turned_v = cross(phi_rad, v);
  return v + (versine_ratio * turned_v + sine_deficit_ratio * cross(phi_rad, turned_v));
}

/// turned() with left_a = (0, 0, left_z) and both turns small.
[[gnu::always_inline]] inline Quadruple turned(double left_z_rad, const Quadruple& q,
                                               const Triple& right_rad) {
  // exp(phi) - 1: its scalar part and the factor of phi in its vector part.
  const double t = squared_norm(right_rad);
  const double scalar =
      t * (-1.0 / 8 + t * (1.0 / 384 + t * (-1.0 / 46080 + t * (1.0 / 10321920))));
  const double factor = 1.0 / 2 + t * (-1.0 / 48 + t * (1.0 / 3840 + t * (-1.0 / 645120)));
  const Triple p = factor * right_rad;
  const Quadruple r = q + Quadruple{scalar * q.w - (q.x * p.x + q.y * p.y + q.z * p.z),
                                    scalar * q.x + (q.w * p.x + q.y * p.z - q.z * p.y),
                                    scalar * q.y + (q.w * p.y + q.z * p.x - q.x * p.z),
                                    scalar * q.z + (q.w * p.z + q.x * p.y - q.y * p.x)};
  // The norm is restored within the addition, as rotation.cpp says.
  const double s = left_z_rad * left_z_rad;
  const double left = left_z_rad * (1.0 / 2 + s * (-1.0 / 48 + s * (1.0 / 3840)));
  const double scale =
      s * (-1.0 / 8 + s * (1.0 / 384 + s * (-1.0 / 46080))) + (0.5 - 0.5 * squared_norm(r));
  return r + Quadruple{scale * r.w - left * r.z, scale * r.x - left * r.y, scale * r.y + left * r.x,
                       scale * r.z + left * r.w};
}

}  // namespace leeway
