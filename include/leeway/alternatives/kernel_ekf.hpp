/// @file
/// The 15-state filter over any covariance kernel: what kernels are compared by.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/covariance/covariance_track.hpp"
#include "leeway/ekf/inertial_estimate.hpp"
#include "leeway/model/gnss_measurement.hpp"

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
        has_gravity_gradient_(config.gravity_gradient),
        inertial_(config, estimate),
        covariance_(std::move(kernel), config.covariance_interval_s) {}

  /// @pre inc.time - inc.dt_s = estimate().nav.time, inc.dt_s > 0.
  void predict(const ImuIncrement& inc) {
    if (has_gravity_gradient_ && covariance_.is_at_start_of_phi()) {
      gravity_gradient_e_ = gravity_gradient_e(estimate().nav.r_e_m);
    }
    ErrorDynamics dynamics = inertial_.advance(inc);
    step_s_ = inc.dt_s;
    dynamics.gravity_gradient_e = gravity_gradient_e_;
    covariance_.propagate(dynamics, inertial_.noise());
  }

  /// Fuses the fix, whatever it says. One that is not usable changes nothing.
  /// @pre fix.time equals estimate().nav.time.
  FusedFix update(const GnssFix& fix) {
    if (!is_usable(fix)) return {};
    covariance_.flush(inertial_.noise());
    const WhiteMeasurement m = inertial_.white_measurement(fix, position_weight(fix.time));
    ErrorVector x_hat = ErrorVector::Zero();
    const double nis = covariance_.kernel().update(x_hat, m.H, m.z);
    inertial_.inject(Error::correction(x_hat));
    covariance_.reset_by(Error::reset(x_hat));
    if (fix.position) last_position_fix_ = fix.time;
    return {static_cast<int>(m.H.rows()), nis};
  }

  const Estimate& estimate() const { return inertial_.estimate(); }

  /// Covariance at the estimate's time. Reading it changes nothing.
  ErrorMatrix covariance() const { return covariance_.matrix(inertial_.noise()); }

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
  double position_weight(Time t) const {
    if (!last_position_fix_) return 1.0;
    return gnss_position_weight(to_seconds(t - *last_position_fix_), gnss_correlation_s_);
  }

  double interval_s_;
  double step_s_{0.0};  // of the newest increment
  double gnss_correlation_s_;
  bool has_gravity_gradient_;
  InertialEstimate inertial_;
  CovarianceTrack<Kernel> covariance_;
  Eigen::Matrix3d gravity_gradient_e_{Eigen::Matrix3d::Zero()};  // where Phi begins
  std::optional<Time> last_position_fix_{};
};

}  // namespace leeway
