/// @file
/// What an IMU reports on a trajectory: the exact increments, then the sensor's errors.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "leeway/sensors/imu.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "leeway/sim/motion/trajectory.hpp"
#include "leeway/sim/tools/random.hpp"

namespace leeway::sim {

/// Integrals of omega_ib_b and f_ib_b from one time to another, both rounded to the nanosecond, by
/// five-point Gauss-Legendre over panels of at most 10 ms that do not straddle a break. The
/// quadrature errs by under 1e-17 of the motion's amplitude at 5 Hz, 4e-11 at 25 Hz.
/// @throws Error unless 0 <= from_s < to_s <= duration of the trajectory, at least 1 ns apart.
ImuIncrement true_increment(const Trajectory& trajectory, double from_s, double to_s);

/// How many increments end at k / rate_hz within the duration.
/// @throws Error unless 0 < rate_hz <= 1e6 and 0 <= duration_s <= duration of the trajectory.
std::size_t increment_count(const Trajectory& trajectory, double rate_hz, double duration_s);

/// Consecutive increments ending at k / rate_hz, from 0 to the duration.
/// @throws Error as increment_count().
std::vector<ImuIncrement> true_increments(const Trajectory& trajectory, double rate_hz,
                                          double duration_s);

/// Errors of one triad of sensors. Part of ImuErrorSimulator.
class TriadErrorSimulator {
 public:
  TriadErrorSimulator(const TriadErrorModel& model, Random& random);

  /// The reported increment. cross_b: what other inputs add to it (g-sensitivity).
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

/// Applies [seed (1)-(2)] and the optional errors of ImuErrorModel to true increments. In order:
/// bias, M, G and white noise; saturation of the mean rate over the increment; quantization, with
/// the residue carried to the next increment as a rate-integrating sensor does. Increments must be
/// consecutive. No heap after construction.
class ImuErrorSimulator {
 public:
  /// Draws the turn-on biases and the stationary start of the in-run ones.
  /// @throws Error when the model is not valid.
  ImuErrorSimulator(const ImuErrorModel& model, const Random& random);

  /// @pre truth.dt_s > 0.
  ImuIncrement measure(const ImuIncrement& truth);

  /// The total biases b of [seed (1)-(2)] at the end of the last increment: known part, turn-on and
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
