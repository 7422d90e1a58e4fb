/// @file
/// A measurement that leaves some directions as they are: the Schmidt update.
#pragma once

#include <Eigen/Core>

#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/ekf/update_outcome.hpp"

namespace leeway {

/// The directions of the error state that an update leaves alone, as columns; zero for none.
using HeldDirections = Eigen::Matrix<double, kErrorStates, 2>;

inline HeldDirections directions_of(Held held, const Estimate& estimate) {
  HeldDirections U = HeldDirections::Zero();
  if (held == Held::kNothing) return U;
  const Eigen::Vector3d down_e = down_e_at(estimate.nav.r_e_m);
  U.col(0).segment<3>(kPsi) = down_e;
  if (held == Held::kHeadingAndTurn) {
    U.col(1).segment<3>(kBg) = estimate.nav.q_eb.conjugate() * down_e;
  }
  return U;
}

/// scalar_update() with a gain that has nothing along U. By Joseph's form with that gain, P is the
/// one of the full update and s d d^T, s the innovation's variance and d the gain left out.
template <class Matrix, class Vector>
void held_scalar_update(Matrix& P, Vector& x, const Vector& h, double z, const HeldDirections& U) {
  const Vector Ph = P * h;
  const double s = h.dot(Ph) + 1.0;
  Vector left_out = Vector::Zero();
  left_out.template head<kErrorStates>() =
      U * (U.transpose() * Ph.template head<kErrorStates>()) / s;
  const double innovation = z - h.dot(x);
  scalar_update(P, x, h, z);
  x -= innovation * left_out;
  P += s * left_out * left_out.transpose();
}

}  // namespace leeway
