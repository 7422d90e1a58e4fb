/// @file
/// The navigation state: what a strapdown integrates.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/earth/time.hpp"

namespace leeway {

/// Attitude, velocity and position of the IMU in the Earth-fixed frame.
struct NavState {
  Time time{};
  Eigen::Quaterniond q_eb{Eigen::Quaterniond::Identity()};  ///< body to ECEF, unit norm
  Eigen::Vector3d v_e_mps{Eigen::Vector3d::Zero()};         ///< Earth-relative velocity in ECEF
  Eigen::Vector3d r_e_m{Eigen::Vector3d::Zero()};           ///< ECEF position
};

/// Navigation state as people read it: geodetic, north-east-down, Euler angles.
struct NavStateNed {
  Time time{};
  Geodetic position{};
  Eigen::Vector3d v_n_mps{Eigen::Vector3d::Zero()};
  EulerAngles attitude{};  ///< body with respect to north-east-down
};

/// State in ECEF, or as people read it; rounding alone, but where Euler angles are not unique.
NavState nav_state_from_ned(const NavStateNed& ned);
NavStateNed ned_from_nav_state(const NavState& state);

}  // namespace leeway
