/// @file
/// What BasicEkf does, for whoever makes one over another kernel or error.
#pragma once

#include <string>

#include "filters/ekf/joint_update.hpp"
#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/ekf/ekf.hpp"

namespace leeway {

/// @throws Error unless P is finite, symmetric, with no negative diagonal element.
inline const ErrorMatrix& checked(const ErrorMatrix& P) {
  if (!P.allFinite() || P.diagonal().minCoeff() < 0.0 ||
      (P - P.transpose()).cwiseAbs().maxCoeff() > 1e-9 * P.cwiseAbs().maxCoeff()) {
    throw Error("initial covariance: must be finite, symmetric, with no negative diagonal element");
  }
  return P;
}

template <CovarianceKernel Kernel, class Error>
BasicEkf<Kernel, Error>::BasicEkf(const EkfConfig& config, const Estimate& estimate,
                                  const Kernel& kernel)
    : inertial_(config, estimate),
      gate_(config.gate_probability),
      covariance_(kernel, config.covariance_interval_s),
      position_weight_(config.gnss_correlation_s) {}

template <CovarianceKernel Kernel, class Error>
BasicEkf<Kernel, Error>::BasicEkf(const EkfConfig& config, const Estimate& estimate,
                                  const ErrorMatrix& P)
    : BasicEkf(config, estimate, Kernel(checked(P))) {}

template <CovarianceKernel Kernel, class Error>
void BasicEkf<Kernel, Error>::predict(const ImuIncrement& inc) {
  // Once for each Phi: over the way of a covariance interval it changes by 3 parts of way / 6370
  // km.
  if (covariance_.is_at_start_of_phi() && inertial_.config().gravity_gradient) {
    gravity_gradient_e_ = gravity_gradient_e(estimate().nav.r_e_m);
  }
  ErrorDynamics dynamics = inertial_.advance(inc);
  dynamics.gravity_gradient_e = gravity_gradient_e_;
  if (!vehicle_ && covariance_.propagate_at_once(dynamics, inertial_.noise())) return;
  if (covariance_.extend(dynamics)) flush();
}

template <CovarianceKernel Kernel, class Error>
void BasicEkf<Kernel, Error>::flush() {
  if (covariance_.is_current()) return;
  const Transition Phi = covariance_.flush(inertial_.noise());
  if (vehicle_) propagate(*vehicle_, Phi);
}

template <CovarianceKernel Kernel, class Error>
UpdateOutcome BasicEkf<Kernel, Error>::judge(const Measurement& m) {
  flush();
  const MeasurementMatrix S =
      innovation_covariance(m, covariance_.kernel().matrix(), vehicle_ ? &*vehicle_ : nullptr);
  return gate_.judge(m, S, estimate().nav.time);
}

template <CovarianceKernel Kernel, class Error>
void BasicEkf<Kernel, Error>::fuse(const Measurement& m, int position_rows, double position_weight,
                                   Held held) {
  const WhiteMeasurement white = whitened(m, position_rows, position_weight, vehicle_.has_value());
  if constexpr (SettableKernel<Kernel>) {
    if (vehicle_ || held != Held::kNothing) {
      Belief present = belief();
      const ErrorVector x_hat = update_jointly(present, white, held);
      set(present);
      return correct(x_hat);
    }
  }
  ErrorVector x_hat = ErrorVector::Zero();
  covariance_.kernel().update(x_hat, white.H, white.z);
  correct(x_hat);
}

template <CovarianceKernel Kernel, class Error>
void BasicEkf<Kernel, Error>::correct(const ErrorVector& x_hat) {
  inertial_.inject(Error::correction(x_hat));
  if constexpr (SettableKernel<Kernel> && requires { Error::attitude_reset(x_hat); }) {
    const Eigen::Matrix3d J = Error::attitude_reset(x_hat);
    covariance_.kernel().turn_attitude(J);
    if (!vehicle_) return;
    vehicle_->cross.template middleRows<3>(kPsi) =
        (J * vehicle_->cross.template middleRows<3>(kPsi)).eval();
  } else {
    covariance_.reset_by(Error::reset(x_hat));
  }
}

template <CovarianceKernel Kernel, class Error>
UpdateOutcome BasicEkf<Kernel, Error>::update(const GnssFix& fix, const FixTrust& trust) {
  if (!is_usable(fix)) {
    UpdateOutcome unusable;
    unusable.time = fix.time;
    return unusable;
  }
  Measurement m = inertial_.measurement(fix);
  if (fix.position) {
    m.R.topLeftCorner<3, 3>() *= trust.position_sigma_scale * trust.position_sigma_scale;
  }
  if (fix.velocity) {
    m.R.bottomRightCorner<3, 3>() *= trust.velocity_sigma_scale * trust.velocity_sigma_scale;
  }
  UpdateOutcome outcome = judge(m);
  if (!fix.velocity) outcome.position_nis = outcome.nis;
  if (!fix.position) outcome.velocity_nis = outcome.nis;
  if (fix.position) outcome.position_innovation_e_m = m.innovation.head<3>();
  if (fix.velocity) outcome.velocity_innovation_e_mps = m.innovation.tail<3>();
  if (outcome.outcome != UpdateOutcome::Outcome::kFused) return outcome;
  const double weight = trust.is_white ? 1.0 : position_weight_.of(fix.time);
  fuse(m, fix.position ? 3 : 0, weight, trust.held);
  if (fix.position) position_weight_.fused(fix.time);
  outcome.covariance_positive = has_positive_variances();
  return outcome;
}

template <CovarianceKernel Kernel, class Error>
UpdateOutcome BasicEkf<Kernel, Error>::update(const Measurement& m, Held held, double weight) {
  UpdateOutcome outcome = judge(m);
  if (outcome.outcome != UpdateOutcome::Outcome::kFused) return outcome;
  fuse(m, m.rows(), weight, held);
  outcome.covariance_positive = has_positive_variances();
  return outcome;
}

/// Of biases that are no states the variance is zero.
template <CovarianceKernel Kernel, class Error>
bool BasicEkf<Kernel, Error>::has_positive_variances() {
  const ErrorVector variance = covariance_.kernel().matrix().diagonal();
  return variance.head<kBa>().minCoeff() > 0.0 &&
         variance.tail<kErrorStates - kBa>().minCoeff() >= 0.0;
}

template <CovarianceKernel Kernel, class Error>
Belief BasicEkf<Kernel, Error>::belief() const {
  BasicEkf present = *this;
  present.flush();
  return {present.estimate(), present.covariance_.kernel().matrix(), present.vehicle_};
}

template <CovarianceKernel Kernel, class Error>
void BasicEkf<Kernel, Error>::set(const Belief& belief) requires SettableKernel<Kernel> {
  inertial_.set(belief.estimate);
  // clang 14 instantiates this for every kernel, whatever the constraint says.
  if constexpr (SettableKernel<Kernel>) covariance_.set(belief.P);
  vehicle_ = belief.vehicle;
}

template <CovarianceKernel Kernel, class Error>
void BasicEkf<Kernel, Error>::turn_body_axes(const Eigen::Matrix3d& C_new_old,
                                             const Eigen::Vector3d& lever_arm_b_m) requires
    SettableKernel<Kernel> {
  ErrorMatrix P = covariance();
  for (const int bias : {kBa, kBg}) transform_block(P, bias, C_new_old);
  if constexpr (SettableKernel<Kernel>) covariance_.set(P);
  inertial_.turn_body_axes(C_new_old, lever_arm_b_m);
  vehicle_.reset();
}

}  // namespace leeway
