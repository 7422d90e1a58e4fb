#include "leeway/alternatives/invariant_ekf.hpp"

#include <Eigen/LU>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway {
namespace {

/// M applied to the error of position and to that of v_e + omega_ie x r_e, which the velocity's is
/// told by.
ErrorVector with_motion_mapped(const ErrorVector& x, const Eigen::Matrix3d& M) {
  const Eigen::Vector3d omega_ie_e = earth_rotation_e_radps();
  const Eigen::Vector3d dr_e = x.segment<3>(kDr);
  const Eigen::Vector3d dr_mapped_e = M * dr_e;
  ErrorVector mapped = x;
  mapped.segment<3>(kDr) = dr_mapped_e;
  mapped.segment<3>(kDv) =
      M * (x.segment<3>(kDv) + omega_ie_e.cross(dr_e)) - omega_ie_e.cross(dr_mapped_e);
  return mapped;
}

}  // namespace

ErrorVector InvariantError::correction(const ErrorVector& xi) {
  return with_motion_mapped(xi, left_jacobian(xi.segment<3>(kPsi)));
}

ErrorVector InvariantError::coordinates(const ErrorVector& x) {
  return with_motion_mapped(x, left_jacobian(x.segment<3>(kPsi)).inverse());
}

Transition InvariantError::reset(const ErrorVector& xi_hat) {
  const Eigen::Matrix3d turn = exp_rotation(xi_hat.segment<3>(kPsi));
  const Eigen::Matrix3d Omega_ie = skew(earth_rotation_e_radps());
  Transition Phi;
  Phi.psi.middleCols<3>(kPsi) = turn;
  Phi.v.middleCols<3>(kDv) = turn;
  Phi.r.middleCols<3>(kDr) = turn;
  Phi.v.middleCols<3>(kDr) = turn * Omega_ie - Omega_ie * turn;
  return Phi;
}

}  // namespace leeway
