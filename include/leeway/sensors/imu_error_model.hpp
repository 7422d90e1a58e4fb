/// @file
/// The IMU error model, [seed (1)-(2)] complete and extended: constant bias, scale factors and
/// misalignments, g-sensitivity, white noise. First-order Gauss-Markov in-run bias, quantization
/// and saturation are options. A model is plain data: leeway/sim/sensors/imu_simulator.hpp applies
/// it to true data, and the filters derive their process noise from it.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "leeway/earth/fields.hpp"

namespace leeway {

/// First-order Gauss-Markov process: stationary sigma and correlation time. A sigma of 0 switches
/// it off; an infinite time makes it a random constant.
struct GaussMarkov {
  double sigma{0.0};
  double tau_s{std::numeric_limits<double>::infinity()};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"sigma", c.sigma, kNotNegative},
                   Field{"tau_s", c.tau_s, kPositiveOrInfinite});
  }
};

/// Exact discretization of a Gauss-Markov process b over a step, and of its integral, which is what
/// an increment carries. With s = tau (1 - phi):
///   b'      = phi b + w1,   integral b = s b + w2.
struct GaussMarkovStep {
  double phi{1.0};            ///< exp(-dt / tau)
  double integral_gain_s{};   ///< tau (1 - phi), dt in the limit of a random constant
  double sigma_end{};         ///< standard deviation of w1
  double integral_slope_s{};  ///< regression of w2 on w1
  double sigma_integral{};    ///< standard deviation of w2 that w1 does not explain, unit * s
};

/// Discretization over dt_s (s): the covariance of (w1, w2) integrated in closed form, by series
/// where dt << tau.
/// @throws Error unless dt_s > 0, sigma >= 0 and tau_s > 0.
GaussMarkovStep discretize(const GaussMarkov& process, double dt_s);

/// One triad of sensors. Its unit u is m/s^2 for accelerometers and rad/s for gyros.
struct TriadErrorModel {
  Eigen::Vector3d bias{Eigen::Vector3d::Zero()};   ///< known constant part of b, u
  double bias_sigma{0.0};                          ///< turn-on spread of b about it, u, per axis
  Eigen::Matrix3d M{Eigen::Matrix3d::Identity()};  ///< scale on, misalignment off the diagonal
  double scale_sigma{0.0};                         ///< spread of M's diagonal from unit to unit
  double misalignment_sigma_rad{0.0};              ///< spread of each element off the diagonal
  double noise_density{0.0};                       ///< white noise, u/sqrt(Hz)
  GaussMarkov in_run{};                            ///< drift of b within a run, u
  double quantum{0.0};                             ///< LSB of the increment, u*s; 0: none
  double range{std::numeric_limits<double>::infinity()};  ///< saturation, +-u

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"bias", c.bias}, Field{"bias_sigma", c.bias_sigma, kNotNegative},
                   Field{"M", c.M}, Field{"scale_sigma", c.scale_sigma, kNotNegative},
                   Field{"misalignment_sigma_rad", c.misalignment_sigma_rad, kNotNegative},
                   Field{"noise_density", c.noise_density, kNotNegative}, Field{"in_run", c.in_run},
                   Field{"quantum", c.quantum, kNotNegative},
                   Field{"range", c.range, kPositiveOrInfinite});
  }
};

/// Both triads of an IMU, and what the gyro feels of the specific force.
struct ImuErrorModel {
  TriadErrorModel accelerometer{};                              ///< [seed (1)], m/s^2
  TriadErrorModel gyro{};                                       ///< [seed (2)], rad/s
  Eigen::Matrix3d G_g_radps_per_mps2{Eigen::Matrix3d::Zero()};  ///< gyro g-sensitivity
  double G_g_sigma_radps_per_mps2{0.0};  ///< spread of each element of it from unit to unit

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"accelerometer", c.accelerometer}, Field{"gyro", c.gyro},
                   Field{"G_g_radps_per_mps2", c.G_g_radps_per_mps2},
                   Field{"G_g_sigma_radps_per_mps2", c.G_g_sigma_radps_per_mps2, kNotNegative});
  }
};

/// @throws Error naming the field, its value and the allowed range: sigmas, densities and quanta
/// finite and >= 0, correlation times and ranges > 0, matrices finite.
void validate(const ImuErrorModel& model);

}  // namespace leeway
