/// @file
/// Covariance of the error state: block-sparse symmetric propagation and the scalar update.
/// P is 15 x 15, full storage, exactly symmetric after every function here.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "leeway/covariance/transition.hpp"
#include "leeway/earth/fields.hpp"
#include "leeway/earth/names.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/vehicle_state.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway {

/// White noise that drives the error state, as power spectral densities; isotropic per triad.
struct ProcessNoise {
  double attitude_rad2_per_s{};  ///< gyro white noise, squared density
  double velocity_m2_per_s3{};   ///< accelerometer white noise, squared density
  double b_a_m2_per_s5{};        ///< drive of the accelerometer bias
  double b_g_rad2_per_s3{};      ///< drive of the gyro bias
  double tau_a_s{std::numeric_limits<double>::infinity()};
  double tau_g_s{std::numeric_limits<double>::infinity()};
};

/// Variance that the noise adds to each error over a time.
inline ErrorVector noise_variance(const ProcessNoise& noise, double dt_s) {
  ErrorVector variance = ErrorVector::Zero();
  variance.segment<3>(kPsi).setConstant(dt_s * noise.attitude_rad2_per_s);
  variance.segment<3>(kDv).setConstant(dt_s * noise.velocity_m2_per_s3);
  variance.segment<3>(kBa).setConstant(dt_s * noise.b_a_m2_per_s5);
  variance.segment<3>(kBg).setConstant(dt_s * noise.b_g_rad2_per_s3);
  return variance;
}

/// How much of a triad's bias model the filter carries.
enum class BiasState {
  kModelled,    ///< as process_noise() has it (default)
  kRandomWalk,  ///< the same drive without the decay: a state that needs no exponential
  kConstant,    ///< as uncertain at the start, and constant
  kNone,        ///< no bias: its state stays zero, and certain
};
constexpr auto names(BiasState) {
  return std::array{"modelled", "random-walk", "constant", "none"};
}

struct BiasStates {
  BiasState accelerometer{BiasState::kModelled};
  BiasState gyro{BiasState::kModelled};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"accelerometer", c.accelerometer}, Field{"gyro", c.gyro});
  }
};

/// What the model means to the filter. An in-run bias without a turn-on part is a Gauss-Markov
/// state. With one it is a random walk of the same drive: a decaying state would pull the constant
/// part, which does not decay, towards zero.
/// @throws Error when the model is invalid.
ProcessNoise process_noise(const ImuErrorModel& model, const BiasStates& biases = {});

/// P <- Phi (P + Q/2) Phi^T + Q/2 with Q = density * Phi.dt_s: the trapezoidal rule for the noise,
/// exact to second order in dt, which needs no Q matrix.
/// Source: Groves (2013) (3.46), "Phi (P + Q/2) Phi^T + Q/2".
void propagate(ErrorMatrix& P, const Transition& Phi, const ProcessNoise& noise);

/// The same for the Phi of one increment, which is not formed: cheaper than advance() and
/// propagate() where P follows every increment.
void propagate(ErrorMatrix& P, const ErrorDynamics& step, const ProcessNoise& noise);

/// What becomes of P when the three errors from `row` on become T times what they are.
void transform_block(ErrorMatrix& P, int row, const Eigen::Matrix3d& T);

/// A scalar measurement of unit variance: z = h x + noise.
/// P <- (I - K h) P (I - K h)^T + K K^T, evaluated as two products (Joseph's form, not its
/// expansion); x_hat <- x_hat + K (z - h x_hat).
/// @returns the innovation variance h P h^T + 1.
double scalar_update(ErrorMatrix& P, ErrorVector& x_hat, const ErrorVector& h, double z);
double scalar_update(JointMatrix& P, JointVector& x_hat, const JointVector& h, double z);

}  // namespace leeway
