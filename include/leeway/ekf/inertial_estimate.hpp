/// @file
/// The estimate that a filter of any kind carries between fixes, and the strapdown that moves it.
#pragma once

#include <Eigen/Core>

#include "leeway/covariance/transition.hpp"
#include "leeway/ekf/ekf_config.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway {

/// Strapdown on increments with the estimated biases removed. Of the configuration it uses the
/// strapdown's policy, the lever arm and the IMU's model. Allocates nothing after construction.
class InertialEstimate {
 public:
  /// @throws Error when configuration or estimate are invalid.
  InertialEstimate(const EkfConfig& config, const Estimate& estimate);

  /// @returns what drives the error over the increment; the gravity gradient is the caller's.
  /// @pre inc.time - inc.dt_s = estimate().nav.time, inc.dt_s > 0.
  ErrorDynamics advance(const ImuIncrement& inc);

  /// The fix, linearized about the estimate. @pre is_usable(fix) at the estimate's time.
  Measurement measurement(const GnssFix& fix) const;

  const Estimate& estimate() const { return estimate_; }
  const EkfConfig& config() const { return config_; }

  /// Noise of the IMU in the present motion.
  ProcessNoise noise() const;

  /// Factor on the deviations of the model's noise.
  double noise_scale() const { return noise_scale_; }
  void set_noise_scale(double sigma_scale) { noise_scale_ = sigma_scale; }

  /// Measured rate (bias not removed) of the newest increment, rad/s; zero before any data.
  const Eigen::Vector3d& omega_ib_b_radps() const { return omega_ib_b_radps_; }

  /// Mean of the measured rate (bias not removed) over the last kMeanRateS, rad/s: the present
  /// motion without the vibration and steering of single samples. Exponentially weighted; zero
  /// before any data.
  const Eigen::Vector3d& mean_omega_ib_b_radps() const { return mean_omega_ib_b_radps_; }
  static constexpr double kMeanRateS = 5.0;

  void set(const Estimate& estimate) { estimate_ = estimate; }

  /// Moves the estimate as leeway::inject() does.
  void inject(const ErrorVector& x) { leeway::inject(estimate_, x); }

  /// Renames the body axes: what was v_b is C_new_old * v_b.
  /// @param lever_arm_b_m  IMU to antenna in the new axes
  void turn_body_axes(const Eigen::Matrix3d& C_new_old, const Eigen::Vector3d& lever_arm_b_m);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(estimate_, history_, omega_ib_b_radps_, mean_omega_ib_b_radps_, mean_force_e_mps2_,
            mean_rate_window_s_, noise_scale_, config_.lever_arm_b_m);
  }

 private:
  EkfConfig config_;
  ProcessNoise noise_;
  StrapdownFunction strapdown_step_;
  Estimate estimate_;
  ImuHistory history_{};
  Eigen::Vector3d omega_ib_b_radps_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d mean_omega_ib_b_radps_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d mean_force_e_mps2_{Eigen::Vector3d::Zero()};  // specific force, likewise
  double noise_scale_{1.0};
  double mean_rate_window_s_{0.0};  // grows to kMeanRateS: the first mean is over all there is
};

}  // namespace leeway
