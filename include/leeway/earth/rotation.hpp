/// @file
/// Rotations: vectors, matrices, quaternions, Euler angles. `C_ab` takes b-coordinates to
/// a-coordinates; `q_ab` is the same rotation as a Hamilton quaternion.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace leeway {

/// Matrix [v x] of a cross product: skew(a) * b = a x b.
template <class Derived>
Eigen::Matrix3d skew(const Eigen::MatrixBase<Derived>& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Quaternion of the rotation vector phi (rad). Exact to rounding for every |phi|.
Eigen::Quaterniond exp_quaternion(const Eigen::Vector3d& phi_rad);

/// Rotation vector of q, |phi| <= pi. Exact to rounding from zero to pi; q need not have w >= 0.
Eigen::Vector3d log_quaternion(const Eigen::Quaterniond& q);

/// Rotation matrix of the rotation vector phi (rad).
Eigen::Matrix3d exp_rotation(const Eigen::Vector3d& phi_rad);

/// Rotation vector of C, |phi| <= pi. @pre C is a proper rotation.
Eigen::Vector3d log_rotation(const Eigen::Matrix3d& C);

/// Left Jacobian of SO(3), 3x3: the mean of exp([s phi x]) over s in 0..1. A specific force that is
/// constant in a body turning at a constant rate integrates to left_jacobian(dtheta) * dv.
/// Source: Barfoot, State Estimation for Robotics, (7.37).
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi_rad);

/// Product left_jacobian(phi) * v, without the matrix.
Eigen::Vector3d left_jacobian_times(const Eigen::Vector3d& phi_rad, const Eigen::Vector3d& v);

/// Quaternion q_ab after small turns on both sides: exp(left_a) * q_ab * exp(right_b). The turns
/// are added as increments: the rounding error of a step is that of one addition, not of a product.
/// The norm is 1 to second order of the rounding error.
Eigen::Quaterniond turned(const Eigen::Vector3d& left_a_rad, const Eigen::Quaterniond& q_ab,
                          const Eigen::Vector3d& right_b_rad);

/// Quaternion of the shortest rotation that takes the direction of `from` to that of `to`. Where
/// they are opposite it is half a turn about some axis across. @pre neither is zero.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// Roll, pitch, yaw (rad) of C_nb = Rz(yaw) Ry(pitch) Rx(roll). For input and output only.
struct EulerAngles {
  double roll_rad{};
  double pitch_rad{};
  double yaw_rad{};
};

/// Rotation matrix C_nb of Euler angles.
Eigen::Matrix3d rotation_from_euler(const EulerAngles& rpy);

/// Euler angles of C_nb: yaw in [0, 2 pi), pitch in [-pi/2, pi/2], roll in (-pi, pi]. Within 1e-8
/// rad of pitch +-pi/2 roll and yaw are not separable: roll is then 0.
EulerAngles euler_from_rotation(const Eigen::Matrix3d& C_nb);

/// Angle (rad) wrapped to (-pi, pi].
double wrap_pi(double angle_rad);

inline constexpr double kRadPerDeg = 0.017453292519943295769;

}  // namespace leeway
