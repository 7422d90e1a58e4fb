/// @file
/// What filters of every kind do between fixes: the estimate and the strapdown that moves it.
#pragma once

#include <Eigen/Core>

#include "leeway/covariance/transition.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway {

/// A measurement whose components are independent and of unit variance.
struct WhiteMeasurement {
  decltype(Measurement::H) H;
  decltype(Measurement::innovation) z;
};

/// Strapdown on increments with the estimated biases removed. Of the configuration it uses the
/// strapdown's policy, the lever arm and the IMU's model. Allocates nothing after construction.
class InertialEstimate {
 public:
  /// @throws Error when configuration or estimate are invalid, as Ekf does.
  InertialEstimate(const EkfConfig& config, const Estimate& estimate);

  /// @returns what drives the error over the increment; the gravity gradient is the caller's.
  /// @pre inc.time - inc.dt_s = estimate().nav.time, inc.dt_s > 0.
  ErrorDynamics advance(const ImuIncrement& inc);

  /// What the fix tells of the error of the estimate. @pre is_usable(fix) at the estimate's time.
  Measurement measurement(const GnssFix& fix) const;

  /// The same, whitened. @param position_weight  a factor on rows and innovation of the position
  WhiteMeasurement white_measurement(const GnssFix& fix, double position_weight) const;

  const Estimate& estimate() const { return estimate_; }
  const ProcessNoise& noise() const { return noise_; }

  /// Moves the estimate as leeway::inject() does.
  void inject(const ErrorVector& x) { leeway::inject(estimate_, x); }

 private:
  ProcessNoise noise_;
  StrapdownFunction strapdown_step_;
  Eigen::Vector3d lever_arm_b_m_;
  Estimate estimate_;
  ImuHistory history_{};
  Eigen::Vector3d omega_ib_b_radps_{Eigen::Vector3d::Zero()};  // of the newest increment
};

}  // namespace leeway
