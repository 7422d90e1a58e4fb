/// @file
/// IMU increments on a trajectory: the true ones, and those with the sensor's errors.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "leeway/sensors/imu.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "leeway/sim/motion/trajectory.hpp"
#include "leeway/sim/tools/random.hpp"

namespace leeway::sim {

/// The true increment between two times, both rounded to the nanosecond: the integrals of
/// omega_ib_b and f_ib_b. Five-point Gauss-Legendre quadrature over panels of at most 10 ms that do
/// not straddle a break. Its error is below 1e-17 of the motion's amplitude at 5 Hz, and 4e-11 at
/// 25 Hz.
/// @throws Error unless 0 <= from_s < to_s <= duration of the trajectory, at least 1 ns apart.
ImuIncrement true_increment(const Trajectory& trajectory, double from_s, double to_s);

/// Number of increments that end at k / rate_hz within the duration.
/// @throws Error unless 0 < rate_hz <= 1e6 and 0 <= duration_s <= duration of the trajectory.
std::size_t increment_count(const Trajectory& trajectory, double rate_hz, double duration_s);

/// Consecutive true increments that end at k / rate_hz, from 0 to the duration.
/// @throws Error as increment_count().
std::vector<ImuIncrement> true_increments(const Trajectory& trajectory, double rate_hz,
                                          double duration_s);

/// Errors of one triad of sensors; a part of ImuErrorSimulator.
class TriadErrorSimulator {
 public:
  TriadErrorSimulator(const TriadErrorModel& model, Random& random);

  /// The measured increment. @param cross_b  increment that other inputs add (g-sensitivity)
  Eigen::Vector3d measure(const Eigen::Vector3d& true_b, const Eigen::Vector3d& cross_b,
                          double dt_s, Random& random);

  Eigen::Vector3d bias() const { return constant_bias_ + in_run_bias_; }

 private:
  void set_step(double dt_s);
  Eigen::Vector3d integrate_in_run_bias(Random& random);
  Eigen::Vector3d quantize(const Eigen::Vector3d& increment_b);

  TriadErrorModel model_;
  Eigen::Vector3d constant_bias_;
  Eigen::Vector3d in_run_bias_;
  Eigen::Vector3d residue_{Eigen::Vector3d::Zero()};  // below the quantum, not yet reported
  double step_dt_s_{0.0};                             // the dt that the next two are for
  double noise_sigma_{0.0};
  GaussMarkovStep in_run_step_{};
};

/// Errors of an IMU, [seed (1)-(2)] and the optional ones of ImuErrorModel, applied to consecutive
/// true increments. First come bias, M, G and white noise, then saturation of the mean rate over
/// the increment, then quantization. Its residue is carried to the next increment, as in a
/// rate-integrating sensor. No heap after construction.
class ImuErrorSimulator {
 public:
  /// A sensor with its turn-on biases and the stationary start of the in-run ones drawn.
  /// @throws Error when the model is not valid.
  ImuErrorSimulator(const ImuErrorModel& model, const Random& random);

  /// The measured increment for the true one. @pre truth.dt_s > 0.
  ImuIncrement measure(const ImuIncrement& truth);

  /// Total biases b of [seed (1)-(2)] at the end of the last increment: known part, turn-on and
  /// in-run.
  Eigen::Vector3d accelerometer_bias_mps2() const { return accelerometer_.bias(); }
  Eigen::Vector3d gyro_bias_radps() const { return gyro_.bias(); }

 private:
  Random random_;
  Eigen::Matrix3d G_g_;
  TriadErrorSimulator accelerometer_;
  TriadErrorSimulator gyro_;
};

}  // namespace leeway::sim
