/// @file
/// Whether IMU increments come often enough for the strapdown that integrates them.
#pragma once

#include <Eigen/Core>
#include <array>

#include "leeway/sensors/imu.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway {

/// Motion that a scheme leaves out, as the steady sensor error that does the same harm, body axes.
struct LeftOut {
  Eigen::Vector3d rate_b_radps{Eigen::Vector3d::Zero()};
  Eigen::Vector3d force_b_mps2{Eigen::Vector3d::Zero()};
};

/// Means over the last kMeanS of the terms by which schemes of rising order differ: each is what
/// the cheaper one leaves out. Of a vibration that increments resolve it is within 5 % for
/// one-sample and 22 % for two-sample; beyond that it is a lower bound. Motion near a multiple of
/// the IMU's rate leaves no trace in increments: against that only a filter before the sampler
/// helps. Allocates nothing. Source: Savage (1998), part 1 (47), part 2 (36), and the same
/// expansion one increment further back; docs/theory/strapdown/integration_monitor.md.
class IntegrationMonitor {
 public:
  static constexpr double kMeanS = 10.0;

  /// @param imu  its white noise is not taken for motion
  /// @throws Error when the model is not valid.
  explicit IntegrationMonitor(const ImuErrorModel& imu = {});

  /// @pre inc.dt_s > 0.
  void push(const ImuIncrement& inc);

  /// Means of what a scheme leaves out; zero in the first second. Of kRungeKutta4 it is what
  /// kTwoSample leaves out.
  LeftOut left_out(Scheme scheme) const;

  /// Whether increments come at least six in a period of the motion; true in the first second. When
  /// false, no scheme can be trusted.
  bool resolves_motion() const;

 private:
  /// Of one triad: how much it varies, and how much from one increment to the next.
  struct Variation {
    Eigen::Vector3d mean_rate{Eigen::Vector3d::Zero()};
    double square{0.0};         // mean of |rate - mean_rate|^2
    double change_square{0.0};  // mean of |change of rate|^2
    void note(const Eigen::Vector3d& rate, const Eigen::Vector3d& last_rate, double gain);
  };

  /// Rates of the newest increments, newest first.
  struct Rates {
    Eigen::Vector3d omega_b_radps{Eigen::Vector3d::Zero()};
    Eigen::Vector3d f_b_mps2{Eigen::Vector3d::Zero()};
  };

  double gyro_noise_;
  double accelerometer_noise_;
  std::array<Rates, 3> recent_{};
  int count_{0};
  double window_s_{0.0};  // grows to kMeanS
  double mean_dt_s_{0.0};
  Variation gyro_{};
  Variation accelerometer_{};
  LeftOut first_order_{};  // of the Euler schemes beyond what is below
  LeftOut pair_{};         // of one-sample beyond what is below
  LeftOut beyond_{};       // of two-sample
};

}  // namespace leeway
