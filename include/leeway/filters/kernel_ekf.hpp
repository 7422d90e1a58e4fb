/// @file
/// The 15-state filter over any covariance kernel: what kernels are compared by.
#pragma once

#include <algorithm>
#include <cmath>
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

/// What a fix said to a filter that refuses none.
struct FusedFix {
  int dof{0};       ///< its components; 0: not usable, nothing was changed
  double nis{0.0};  ///< normalized innovation squared, by the weights it was fused with
};

/// Ekf without its gate, its repairs and the vehicle, on a covariance of any form. Allocates
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
    step_s_ = inc.dt_s;
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
  FusedFix update(const GnssFix& fix) {
    if (!is_usable(fix)) return {};
    flush();
    const WhiteMeasurement m = inertial_.white_measurement(fix, position_weight(fix.time));
    ErrorVector x_hat = ErrorVector::Zero();
    const double nis = kernel_.update(x_hat, m.H, m.z);
    inertial_.inject(Error::correction(x_hat));
    // The reset is the first factor of the next Phi: no kernel need know of it, and it costs none
    // a propagation.
    Phi_ = Error::reset(x_hat);
    is_flushed_ = false;
    if (fix.position) last_position_fix_ = fix.time;
    return {static_cast<int>(m.H.rows()), nis};
  }

  const Estimate& estimate() const { return inertial_.estimate(); }

  /// Covariance at the estimate's time. Reading it changes nothing.
  ErrorMatrix covariance() const {
    Kernel current = kernel_;
    if (!is_flushed_) current.propagate(Phi_, inertial_.noise());
    return current.matrix();
  }

  /// By how much of itself the process noise of one propagation is changed when the kernel's
  /// numbers take it in, of the state where that is most. 1: it is lost to rounding. The state
  /// grows too sure where this stays above a half for as long as the noise takes to matter.
  double noise_rounding() const {
    using Number = typename Kernel::Number;
    const ErrorVector variance = covariance().diagonal();
    const ErrorVector q = noise_variance(inertial_.noise(), 0.5 * std::max(interval_s_, step_s_));
    double largest = 0.0;
    for (int i = 0; i < kErrorStates; ++i) {
      const auto before = static_cast<Number>(variance(i));
      const auto added = static_cast<Number>(q(i));
      if (!(added > 0)) continue;
      const Number kept = (before + added) - before;
      largest = std::max(largest, static_cast<double>(std::abs(kept / added - 1)));
    }
    return largest;
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
  double step_s_{0.0};  // of the newest increment
  double gnss_correlation_s_;
  InertialPart inertial_;
  Kernel kernel_;
  Transition Phi_{};
  bool is_flushed_{true};                                        // Phi_ is the identity
  Eigen::Matrix3d gravity_gradient_e_{Eigen::Matrix3d::Zero()};  // where Phi_ begins
  std::optional<Time> last_position_fix_{};
};

}  // namespace leeway
