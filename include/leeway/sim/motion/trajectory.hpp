/// @file
/// Truth as functions of time. Every true quantity is derived from one closed-form motion, so all
/// of them agree to rounding.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/sim/motion/jet.hpp"
#include "leeway/strapdown/nav_state.hpp"

namespace leeway::sim {

/// The tangent plane at an origin, with the axes l: north, east, down at the origin. It does not
/// follow the Earth's curvature: 1 km away it is 0.08 m higher and its down is 1.6e-4 rad off the
/// local one. A motion that does follow the curvature uses the same axes as mere coordinates
/// (waypoints.hpp).
struct TangentPlane {
  TangentPlane() : TangentPlane(Geodetic{}) {}
  explicit TangentPlane(const Geodetic& at)
      : origin(at), origin_e_m(ecef_from_geodetic(at)), C_el(ned_to_ecef(at)) {}

  Geodetic origin;
  Eigen::Vector3d origin_e_m;
  Eigen::Matrix3d C_el;
};

/// Motion of the IMU in a tangent plane, body forward-right-down:
/// C_lb = Rz(yaw) Ry(pitch) Rx(roll).
struct LocalMotion {
  Jet north_m{};
  Jet east_m{};
  Jet down_m{};
  Jet roll_rad{};
  Jet pitch_rad{};
  Jet yaw_rad{};
};

/// A motion of the IMU over a finite time.
struct Trajectory {
  std::string name{};
  TangentPlane plane{};
  double duration_s{};                              ///< the truth is defined on 0 to duration_s
  std::function<LocalMotion(double t_s)> motion{};  ///< pure: safe to share between threads
  std::vector<double> breaks_s{};                   ///< times where a derivative jumps, ascending
  std::optional<double> period_s{};  ///< time after which the motion repeats; studies may use it
};

/// The truth at one time. Satisfies exactly
///   d v_e/dt = C_eb f_ib_b - 2 omega_ie x v_e + gravity_e<kNormal>(r_e),
///   d C_eb/dt = C_eb [omega_ib_b x] - [omega_ie x] C_eb.
struct TruthPoint {
  NavState nav{};
  Eigen::Vector3d omega_ib_b_radps{Eigen::Vector3d::Zero()};
  Eigen::Vector3d f_ib_b_mps2{Eigen::Vector3d::Zero()};
};

/// The truth at the time t_s; at a break that just after it. Rounding errors at the Earth's
/// surface: position 2e-9 m, velocity 1e-13 m/s, attitude 1e-14 rad, rate 1e-13 rad/s, specific
/// force 2e-13 m/s^2.
/// @throws Error when the trajectory has no motion.
TruthPoint truth_at(const Trajectory& trajectory, double t_s);

}  // namespace leeway::sim
