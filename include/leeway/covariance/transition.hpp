/// @file
/// The transition matrix of the error state by its blocks, accumulated at the IMU rate.
#pragma once

#include <Eigen/Core>

#include "leeway/model/error_state.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway {

/// Phi over an interval, by its rows: what changes, because of which of the 15 errors. Rows of the
/// biases are scalars times identity. Attitude depends on attitude and gyro bias alone.
struct Transition {
  /// 3 x 16, the last column zero, so that vectors of 2, 4 or 8 numbers divide a row.
  using Rows = Eigen::Matrix<double, 3, kErrorStates + 1, Eigen::RowMajor | Eigen::DontAlign>;

  double dt_s{0.0};
  Rows psi{identity(kPsi)}, v{identity(kDv)}, r{identity(kDr)};
  double a_a{1.0}, g_g{1.0};

  /// Of the identity, the rows of the three errors from `first` on.
  static Rows identity(int first) {
    Rows rows = Rows::Zero();
    rows.middleCols<3>(first).setIdentity();
    return rows;
  }
};

/// What drives the error over one IMU increment.
struct ErrorDynamics {
  double dt_s{};
  Eigen::Matrix3d C_eb_mean{Eigen::Matrix3d::Identity()};
  Eigen::Vector3d dv_f_e_mps{Eigen::Vector3d::Zero()};          ///< integral of specific force
  Eigen::Matrix3d gravity_gradient_e{Eigen::Matrix3d::Zero()};  ///< 1/s^2
  double a_a{1.0}, g_g{1.0};  ///< what the step leaves of the biases, by bias_decay()
};

/// What is left of a bias of this correlation time: exp(-dt / tau), 1 for an infinite time.
double bias_decay(double dt_s, double tau_s);

/// Extends Phi by one increment: Phi <- Phi(step) Phi. Second order in the step length.
/// Source: Groves (2013) (14.18)-(14.21), (14.48)-(14.49) with the gradient of the normal field,
/// signs by error_state.hpp.
void advance(Transition& Phi, const ErrorDynamics& step);

/// Phi over two intervals in a row: later * earlier, block by block.
Transition compose(const Transition& later, const Transition& earlier);

/// The continuous system matrix, dense. For tests and analysis; advance() does not form it.
/// @param f_e_mps2  specific force in ECEF
ErrorMatrix system_matrix(const Eigen::Matrix3d& C_eb, const Eigen::Vector3d& f_e_mps2,
                          const Eigen::Matrix3d& gravity_gradient_e, double tau_a_s,
                          double tau_g_s);

/// Phi X: what becomes of errors, the columns of X, in their precision.
template <class Errors>
typename Errors::PlainObject times(const Transition& Phi, const Eigen::MatrixBase<Errors>& X) {
  using Scalar = typename Errors::Scalar;
  const auto& x = X.derived().eval();  // X itself unless it is an expression
  const auto product = [&x](const Transition::Rows& rows) {
    return rows.template leftCols<kErrorStates>().template cast<Scalar>().lazyProduct(x);
  };
  typename Errors::PlainObject y;
  y.template middleRows<3>(kPsi) = product(Phi.psi);
  y.template middleRows<3>(kDv) = product(Phi.v);
  y.template middleRows<3>(kDr) = product(Phi.r);
  y.template middleRows<3>(kBa) = static_cast<Scalar>(Phi.a_a) * x.template middleRows<3>(kBa);
  y.template middleRows<3>(kBg) = static_cast<Scalar>(Phi.g_g) * x.template middleRows<3>(kBg);
  return y;
}

/// Phi as a dense matrix.
ErrorMatrix dense(const Transition& Phi);

}  // namespace leeway
