#include "leeway/model/claimed_solution.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"

namespace leeway {
namespace {

/// Turns about north, east and down, small, to changes of roll, pitch and yaw. Near pitch +-90 deg
/// roll and yaw lose their meaning; the bound keeps their sigmas finite.
Eigen::Matrix3d euler_from_turn(const EulerAngles& attitude) {
  const auto [roll, pitch, yaw] = attitude;
  const double cos_pitch = std::max(std::cos(pitch), 1e-3);
  Eigen::Matrix3d euler_from_psi;
  euler_from_psi << std::cos(yaw) / cos_pitch, std::sin(yaw) / cos_pitch, 0.0,  //
      -std::sin(yaw), std::cos(yaw), 0.0,                                       //
      std::cos(yaw) * std::sin(pitch) / cos_pitch, std::sin(yaw) * std::sin(pitch) / cos_pitch, 1.0;
  return euler_from_psi;
}

/// Square roots of the diagonal of C P C^T for three errors from row i on.
Eigen::Vector3d sigma_of(const ErrorMatrix& P, int i, const Eigen::Matrix3d& C) {
  return (C * P.block<3, 3>(i, i) * C.transpose()).diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace

Solution solution(const Estimate& estimate, const ErrorMatrix& P) {
  const NavStateNed ned = ned_from_nav_state(estimate.nav);
  const Eigen::Matrix3d C_ne = ned_to_ecef(ned.position).transpose();
  Solution s;
  s.nav = estimate.nav;
  s.b_a_mps2 = estimate.bias.b_a_mps2;
  s.b_g_radps = estimate.bias.b_g_radps;
  s.sigma_position_n_m = sigma_of(P, kDr, C_ne);
  s.sigma_velocity_n_mps = sigma_of(P, kDv, C_ne);
  s.sigma_attitude_rad = sigma_of(P, kPsi, euler_from_turn(ned.attitude) * C_ne);
  s.sigma_b_a_mps2 = P.diagonal().segment<3>(kBa).cwiseMax(0.0).cwiseSqrt();
  s.sigma_b_g_radps = P.diagonal().segment<3>(kBg).cwiseMax(0.0).cwiseSqrt();
  return s;
}

}  // namespace leeway
