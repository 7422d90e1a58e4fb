/// @file
/// The mechanization of textbooks that the library does not have: latitude, longitude, and north,
/// east and down where the vehicle is.
#pragma once

#include <Eigen/Core>

#include "leeway/earth/earth.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/strapdown/nav_state.hpp"

namespace leeway::sim {

/// Second order: midpoint of the velocity, attitude and force by increments. Source: Groves (2013),
/// section 5.4.
class NedMechanization {
 public:
  explicit NedMechanization(const NavState& start);

  void push(const ImuIncrement& inc);

  /// Latitude and longitude move by a share of what is left to a position, as numbers.
  void correct(const Geodetic& position, double share);

  Eigen::Vector3d r_e_m() const { return ecef_from_geodetic(position_); }

 private:
  Geodetic position_;
  Eigen::Vector3d v_n_mps_;
  Eigen::Matrix3d C_nb_;
};

}  // namespace leeway::sim
