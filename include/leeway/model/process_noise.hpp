/// @file
/// The white noise that drives the error state, from the error model of the IMU.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>

#include "leeway/earth/fields.hpp"
#include "leeway/earth/names.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway {

/// White noise that drives the error state, as power spectral densities; isotropic per triad.
struct ProcessNoise {
  double attitude_rad2_per_s{};  ///< gyro white noise, squared density
  double velocity_m2_per_s3{};   ///< accelerometer white noise, squared density
  double b_a_m2_per_s5{};        ///< drive of the accelerometer bias
  double b_g_rad2_per_s3{};      ///< drive of the gyro bias
  double tau_a_s{std::numeric_limits<double>::infinity()};  ///< decay of the accelerometer bias
  double tau_g_s{std::numeric_limits<double>::infinity()};  ///< decay of the gyro bias
};

/// Variance that the noise adds to each of the 15 errors over a time.
inline ErrorVector noise_variance(const ProcessNoise& noise, double dt_s) {
  ErrorVector variance = ErrorVector::Zero();
  variance.segment<3>(kPsi).setConstant(dt_s * noise.attitude_rad2_per_s);
  variance.segment<3>(kDv).setConstant(dt_s * noise.velocity_m2_per_s3);
  variance.segment<3>(kBa).setConstant(dt_s * noise.b_a_m2_per_s5);
  variance.segment<3>(kBg).setConstant(dt_s * noise.b_g_rad2_per_s3);
  return variance;
}

/// Share of a triad's bias model that the filter carries.
enum class BiasState {
  kModelled,    ///< as process_noise() has it (default)
  kRandomWalk,  ///< the same drive without the decay: a state that needs no exponential
  kConstant,    ///< as uncertain at the start, and constant
  kNone,        ///< no bias: its state stays zero, and certain
};
constexpr auto names(BiasState) {
  return std::array{"modelled", "random-walk", "constant", "none"};
}

/// Choice of bias states by triad.
struct BiasStates {
  BiasState accelerometer{BiasState::kModelled};
  BiasState gyro{BiasState::kModelled};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"accelerometer", c.accelerometer}, Field{"gyro", c.gyro});
  }
};

/// Noise by which a filter follows the model. An in-run bias without a turn-on part is a
/// Gauss-Markov state. With one it is a random walk of the same drive: a decaying state would pull
/// the constant part, which does not decay, towards zero.
/// @throws Error when the model is invalid.
ProcessNoise process_noise(const ImuErrorModel& model, const BiasStates& biases = {});

/// What the vehicle does on average over a few seconds.
struct MeanMotion {
  Eigen::Vector3d omega_ib_b_radps{Eigen::Vector3d::Zero()};
  Eigen::Vector3d acceleration_e_mps2{Eigen::Vector3d::Zero()};  ///< relative to the Earth
};

/// The noise with what scale factors, misalignments and g-sensitivity add to it, which are no
/// states: an error in proportion to the motion, of variance sigma^2 |motion|^2, that lasts as long
/// as a turn, 5 s. At constant velocity there is none: what they make of gravity is in the bias.
ProcessNoise with_motion(const ProcessNoise& noise, const ImuErrorModel& model,
                         const MeanMotion& motion);

/// The noise of an IMU whose errors are larger by a factor.
ProcessNoise scaled(const ProcessNoise& noise, double sigma_scale);

}  // namespace leeway
