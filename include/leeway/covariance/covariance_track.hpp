/// @file
/// A covariance that follows increments now and then: Phi is accumulated at every one of them, the
/// kernel propagated when an interval has passed.
#pragma once

#include <utility>

#include "leeway/covariance/covariance_kernel.hpp"

namespace leeway {

template <CovarianceKernel Kernel>
class CovarianceTrack {
 public:
  /// @param interval_s  0: the kernel follows every increment
  CovarianceTrack(Kernel kernel, double interval_s)
      : kernel_(std::move(kernel)), interval_s_(interval_s) {}

  /// Whether Phi begins here: what holds for the whole of it may be taken anew.
  bool is_at_start_of_phi() const { return Phi_.dt_s == 0.0; }

  void propagate(const ErrorDynamics& dynamics, const ProcessNoise& noise) {
    if constexpr (requires { kernel_.propagate(dynamics, noise); }) {
      if (interval_s_ == 0.0 && is_flushed_) {
        // Phi of the one increment need not be formed.
        kernel_.propagate(dynamics, noise);
        return;
      }
    }
    advance(Phi_, dynamics);
    is_flushed_ = false;
    // Half an increment of slack, so that rounding does not shift the moment.
    if (Phi_.dt_s + 0.5 * dynamics.dt_s > interval_s_) flush(noise);
  }

  /// Brings the kernel up to the present.
  void flush(const ProcessNoise& noise) {
    if (is_flushed_) return;
    kernel_.propagate(Phi_, noise);
    Phi_ = Transition{};
    is_flushed_ = true;
  }

  /// What a correction makes of the error that remains, as the first factor of the next Phi: no
  /// kernel need know of it, and it costs none a propagation. @pre flushed
  void reset_by(const Transition& reset) {
    Phi_ = reset;
    is_flushed_ = false;
  }

  Kernel& kernel() { return kernel_; }

  /// At present. Reading it changes nothing.
  ErrorMatrix matrix(const ProcessNoise& noise) const {
    CovarianceTrack current = *this;
    current.flush(noise);
    return current.kernel_.matrix();
  }

 private:
  Kernel kernel_;
  double interval_s_;
  Transition Phi_{};
  bool is_flushed_{true};  // Phi_ is the identity
};

}  // namespace leeway
