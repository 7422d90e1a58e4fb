#include "leeway/sim/motion/trajectory.hpp"

#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway::sim {
namespace {

/// Turn rate of the body in the tangent plane from the rates of the Euler angles.
Eigen::Vector3d omega_lb_b(const LocalMotion& m, const Eigen::Matrix3d& C_lb) {
  const double sin_roll = std::sin(m.roll_rad.value);
  const double cos_roll = std::cos(m.roll_rad.value);
  const Eigen::Vector3d down_axis_b = C_lb.row(2).transpose();
  return m.yaw_rad.first * down_axis_b +
         m.pitch_rad.first * Eigen::Vector3d(0.0, cos_roll, -sin_roll) +
         m.roll_rad.first * Eigen::Vector3d::UnitX();
}

}  // namespace

TruthPoint truth_at(const Trajectory& trajectory, double t_s) {
  if (!trajectory.motion) throw Error("trajectory '" + trajectory.name + "' has no motion");
  const LocalMotion m = trajectory.motion(t_s);
  const TangentPlane& plane = trajectory.plane;
  const Eigen::Matrix3d C_lb =
      rotation_from_euler({m.roll_rad.value, m.pitch_rad.value, m.yaw_rad.value});
  const Eigen::Matrix3d C_eb = plane.C_el * C_lb;
  const Eigen::Vector3d omega_ie_e = earth_rotation_e_radps();

  TruthPoint truth;
  truth.nav.time = time_from_seconds(t_s);
  truth.nav.q_eb = Eigen::Quaterniond(C_eb).normalized();
  truth.nav.r_e_m = plane.origin_e_m +
                    plane.C_el * Eigen::Vector3d(m.north_m.value, m.east_m.value, m.down_m.value);
  truth.nav.v_e_mps = plane.C_el * Eigen::Vector3d(m.north_m.first, m.east_m.first, m.down_m.first);
  const Eigen::Vector3d a_e_mps2 =
      plane.C_el * Eigen::Vector3d(m.north_m.second, m.east_m.second, m.down_m.second);
  truth.omega_ib_b_radps = omega_lb_b(m, C_lb) + C_eb.transpose() * omega_ie_e;
  truth.f_ib_b_mps2 = C_eb.transpose() * (a_e_mps2 + 2.0 * omega_ie_e.cross(truth.nav.v_e_mps) -
                                          gravity_e<GravityModel::kNormal>(truth.nav.r_e_m));
  return truth;
}

}  // namespace leeway::sim
