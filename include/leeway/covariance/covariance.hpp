/// @file
/// Covariance of the error state: block-sparse symmetric propagation and the scalar update.
/// P is 15 x 15, full storage, exactly symmetric after every function here.
#pragma once

#include <Eigen/Core>

#include "leeway/covariance/transition.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/model/vehicle_state.hpp"

namespace leeway {

/// P <- Phi (P + Q/2) Phi^T + Q/2 with Q = density * Phi.dt_s: the trapezoidal rule for the noise,
/// exact to second order in dt, which needs no Q matrix.
/// Source: Groves (2013) (3.46), "Phi (P + Q/2) Phi^T + Q/2".
void propagate(ErrorMatrix& P, const Transition& Phi, const ProcessNoise& noise);

/// The same for the Phi of one increment, which is not formed: cheaper than advance() and
/// propagate() where P follows every increment.
void propagate(ErrorMatrix& P, const ErrorDynamics& step, const ProcessNoise& noise);

/// What the parameters of the vehicle and their covariance with the errors become over Phi.
void propagate(VehicleState& vehicle, const Transition& Phi);

/// What becomes of P when the three errors from `row` on become T times what they are.
void transform_block(ErrorMatrix& P, int row, const Eigen::Matrix3d& T);

/// Whether every direction of the error has a variance: the Cholesky factor exists.
bool is_positive_definite(const ErrorMatrix& P);

/// A scalar measurement of unit variance: z = h x + noise.
/// P <- (I - K h) P (I - K h)^T + K K^T, evaluated as two products (Joseph's form, not its
/// expansion); x_hat <- x_hat + K (z - h x_hat).
/// @returns the innovation variance h P h^T + 1.
double scalar_update(ErrorMatrix& P, ErrorVector& x_hat, const ErrorVector& h, double z);
double scalar_update(JointMatrix& P, JointVector& x_hat, const JointVector& h, double z);

}  // namespace leeway
