/// @file
/// The 15-state error-state extended Kalman filter around the strapdown.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/covariance/covariance.hpp"
#include "leeway/covariance/covariance_track.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/covariance/transition.hpp"
#include "leeway/earth/fields.hpp"
#include "leeway/ekf/belief.hpp"
#include "leeway/ekf/ekf_config.hpp"
#include "leeway/ekf/fix_gate.hpp"
#include "leeway/ekf/inertial_estimate.hpp"
#include "leeway/ekf/update_outcome.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/heading.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"

namespace leeway {

/// The error of error_state.hpp as it stands: a correction is added.
struct AdditiveError {
  /// Correction that inject() is to be given for the estimated error.
  static ErrorVector correction(const ErrorVector& x_hat) { return x_hat; }

  /// Change of the attitude error that remains; the other errors stay as they are.
  static Eigen::Matrix3d attitude_reset(const ErrorVector& x_hat) { return reset_jacobian(x_hat); }

  /// The same among all errors.
  static Transition reset(const ErrorVector& x_hat) {
    Transition Phi;
    Phi.psi.middleCols<3>(kPsi) = attitude_reset(x_hat);
    return Phi;
  }
};

/// Estimate, covariance, gate and the vehicle's parameters, composed. predict and update allocate
/// nothing, throw nothing, log nothing; same inputs give the same bits.
/// @tparam Kernel  how the covariance is stored. The vehicle's parameters, and directions that are
/// held, need a SettableKernel.
/// @tparam Error  AdditiveError, or InvariantError (invariant_ekf.hpp): the error that P is of.
/// They agree to first order.
template <CovarianceKernel Kernel, class Error = AdditiveError>
class BasicEkf {
 public:
  /// @throws Error when configuration or estimate are invalid: the field, its value, the allowed
  /// range.
  BasicEkf(const EkfConfig& config, const Estimate& estimate, const Kernel& kernel);

  /// @throws Error as above, and unless P is finite, symmetric, with no negative diagonal element.
  BasicEkf(const EkfConfig& config, const Estimate& estimate, const ErrorMatrix& P);

  /// Advances by one increment. @pre inc.time - inc.dt_s = estimate().nav.time, inc.dt_s > 0.
  void predict(const ImuIncrement& inc);

  /// Gates the whole fix, then fuses it. @pre fix.time equals estimate().nav.time.
  UpdateOutcome update(const GnssFix& fix, const FixTrust& trust = {});

  /// The same for any measurement at the time of the estimate. @pre m.R is positive definite.
  /// @param weight  of what the gate lets through, as gnss_position_weight()
  UpdateOutcome update(const Measurement& m, Held held = Held::kNothing, double weight = 1.0);

  const Estimate& estimate() const { return inertial_.estimate(); }

  /// Covariance at the estimate's time. Reading it changes nothing.
  ErrorMatrix covariance() const { return covariance_.matrix(inertial_.noise()); }

  /// The covariance as it was last propagated: up to a covariance interval old, at no cost.
  const Kernel& kernel() const { return covariance_.kernel(); }

  /// Whether the covariance has been propagated up to the estimate's time.
  bool covariance_is_current() const { return covariance_.is_current(); }

  /// The parameters of the vehicle, where they are estimated, at the time of the last propagation.
  const std::optional<VehicleState>& vehicle() const { return vehicle_; }

  const InertialEstimate& inertial() const { return inertial_; }

  /// Estimate, covariance and parameters at the present.
  Belief belief() const;

  /// Puts another belief in place of what the filter has found.
  /// @pre P symmetric positive semidefinite, everything finite.
  void set(const Belief& belief) requires SettableKernel<Kernel>;

  /// Takes the IMU for as much noisier than its model says, from here on.
  void scale_imu_noise(double sigma_scale) { inertial_.set_noise_scale(sigma_scale); }

  /// Renames the body axes: what was v_b is C_new_old * v_b. The vehicle's parameters are
  /// forgotten.
  /// @param lever_arm_b_m  IMU to antenna in the new axes
  void turn_body_axes(const Eigen::Matrix3d& C_new_old,
                      const Eigen::Vector3d& lever_arm_b_m) requires SettableKernel<Kernel>;

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(inertial_, covariance_, vehicle_, gravity_gradient_e_, position_weight_);
  }

 private:
  void flush();
  UpdateOutcome judge(const Measurement& m);
  void fuse(const Measurement& m, int position_rows, double position_weight, Held held);
  void correct(const ErrorVector& x_hat);
  bool has_positive_variances();

  InertialEstimate inertial_;
  FixGate gate_;
  CovarianceTrack<Kernel> covariance_;
  std::optional<VehicleState> vehicle_{};
  Eigen::Matrix3d gravity_gradient_e_{Eigen::Matrix3d::Zero()};  // where Phi begins
  PositionWeight position_weight_;
};

/// The filter that vehicles run.
using Ekf = BasicEkf<SymmetricKernel<double>>;
extern template class BasicEkf<SymmetricKernel<double>>;

/// Lets f, a void(Belief&), change what the filter believes.
template <class F>
void edit(Ekf& filter, F&& f) {
  Belief belief = filter.belief();
  f(belief);
  filter.set(belief);
}

/// bridge() of what the filter believes. @pre to > filter.estimate().nav.time.
void bridge(Ekf& filter, Time to, double before_s = 0.0);

/// 1 sigma of the attitude error about the vertical, rad; of the last propagation.
double heading_sigma_rad(const Ekf& filter);

/// rest_hides_heading() of this filter, of the last propagation.
bool rest_hides_heading(const Ekf& filter);

/// Makes P positive definite where it is not. @returns whether there was nothing to repair
bool repair_covariance(Ekf& filter);

/// A filter of this configuration at some place on Earth: to see whether there can be one.
/// @throws Error when the configuration is invalid.
Ekf filter_anywhere(const EkfConfig& config);

}  // namespace leeway
