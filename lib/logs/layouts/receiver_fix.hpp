/// @file
/// Fixes as receivers tell them: accuracies of several axes together. Private to the log readers.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// Standard deviations of more than one axis, as root sums of squares.
struct ReceiverAccuracy {
  double horizontal_m{};  ///< of north and east
  double vertical_m{};
  double speed_mps{};  ///< of three axes
};

/// The fix of a receiver, its accuracies shared evenly by the axes they are of.
/// @param v_n_mps  nothing where there is no velocity
inline GnssFix receiver_fix(Time time, const Geodetic& place,
                            const std::optional<Eigen::Vector3d>& v_n_mps,
                            const ReceiverAccuracy& accuracy) {
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  const double h2 = accuracy.horizontal_m * accuracy.horizontal_m / 2.0;
  const Eigen::Vector3d R_n_m2(h2, h2, accuracy.vertical_m * accuracy.vertical_m);
  GnssFix fix{.time = time};
  fix.position =
      GnssPosition{ecef_from_geodetic(place), C_en * R_n_m2.asDiagonal() * C_en.transpose()};
  if (v_n_mps) {
    const double s2 = accuracy.speed_mps * accuracy.speed_mps / 3.0;
    fix.velocity = GnssVelocity{C_en * *v_n_mps, s2 * Eigen::Matrix3d::Identity()};
  }
  return fix;
}

}  // namespace leeway
