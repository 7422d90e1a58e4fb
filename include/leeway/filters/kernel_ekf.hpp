/// @file
/// The 15-state filter over any covariance kernel: what kernels are compared by.
#pragma once

#include <optional>
#include <utility>

#include "leeway/filters/covariance_kernel.hpp"
#include "leeway/filters/gnss_measurement.hpp"
#include "leeway/filters/inertial_part.hpp"

namespace leeway {

/// The error of error_state.hpp as it stands: a correction is added.
struct AdditiveError {
  /// What inject() is to be given for the estimated error.
  static ErrorVector correction(const ErrorVector& x_hat) { return x_hat; }

  /// What the correction makes of the error that remains.
  static Transition reset(const ErrorVector& x_hat) {
    Transition Phi;
    Phi.psi.middleCols<3>(kPsi) = reset_jacobian(x_hat);
    return Phi;
  }
};

/// Ekf without its gate, its monitors and the vehicle, on a covariance of any form. Allocates
/// nothing after construction beyond what the kernel does, which is nothing.
/// @tparam Error  AdditiveError, or InvariantError (invariant_ekf.hpp): which error it is that P is
/// of. They agree to first order.
template <CovarianceKernel Kernel, class Error = AdditiveError>
class KernelEkf {
 public:
  /// @param kernel  holds the covariance of the estimate
  /// @throws Error when configuration or estimate are invalid.
  KernelEkf(const EkfConfig& config, const Estimate& estimate, Kernel kernel)
      : interval_s_(config.covariance_interval_s),
        gnss_correlation_s_(config.gnss_correlation_s),
        inertial_(config, estimate),
        kernel_(std::move(kernel)) {}

  /// @pre inc.time - inc.dt_s = estimate().nav.time, inc.dt_s > 0.
  void predict(const ImuIncrement& inc) {
    if (Phi_.dt_s == 0.0) gravity_gradient_e_ = gravity_gradient_e(estimate().nav.r_e_m);
    ErrorDynamics dynamics = inertial_.advance(inc);
    dynamics.gravity_gradient_e = gravity_gradient_e_;
    if constexpr (requires { kernel_.propagate(dynamics, inertial_.noise()); }) {
      if (interval_s_ == 0.0 && is_flushed_) {
        // Phi of the one increment need not be formed.
        kernel_.propagate(dynamics, inertial_.noise());
        return;
      }
    }
    advance(Phi_, dynamics);
    is_flushed_ = false;
    // Half an increment of slack, so that rounding does not shift the moment.
    if (Phi_.dt_s + 0.5 * inc.dt_s > interval_s_) flush();
  }

  /// Fuses the fix, whatever it says. One that is not usable changes nothing.
  /// @pre fix.time equals estimate().nav.time.
  void update(const GnssFix& fix) {
    if (!is_usable(fix)) return;
    flush();
    const WhiteMeasurement m = inertial_.white_measurement(fix, position_weight(fix.time));
    ErrorVector x_hat = ErrorVector::Zero();
    kernel_.update(x_hat, m.H, m.z);
    inertial_.inject(Error::correction(x_hat));
    // The reset is the first factor of the next Phi: no kernel need know of it, and it costs none
    // a propagation.
    Phi_ = Error::reset(x_hat);
    is_flushed_ = false;
    if (fix.position) last_position_fix_ = fix.time;
  }

  const Estimate& estimate() const { return inertial_.estimate(); }

  /// Covariance at the estimate's time. Reading it changes nothing.
  ErrorMatrix covariance() const {
    Kernel current = kernel_;
    if (!is_flushed_) current.propagate(Phi_, inertial_.noise());
    return current.matrix();
  }

 private:
  void flush() {
    if (is_flushed_) return;
    kernel_.propagate(Phi_, inertial_.noise());
    Phi_ = Transition{};
    is_flushed_ = true;
  }

  double position_weight(Time t) const {
    if (!last_position_fix_) return 1.0;
    return gnss_position_weight(to_seconds(t - *last_position_fix_), gnss_correlation_s_);
  }

  double interval_s_;
  double gnss_correlation_s_;
  InertialPart inertial_;
  Kernel kernel_;
  Transition Phi_{};
  bool is_flushed_{true};                                        // Phi_ is the identity
  Eigen::Matrix3d gravity_gradient_e_{Eigen::Matrix3d::Zero()};  // where Phi_ begins
  std::optional<Time> last_position_fix_{};
};

}  // namespace leeway
