/// @file
/// A covariance that follows increments now and then: Phi is accumulated at every one of them, the
/// kernel propagated when an interval has passed.
#pragma once

#include <utility>

#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {

template <CovarianceKernel Kernel>
class CovarianceTrack {
 public:
  /// @param interval_s  0: the kernel follows every increment
  CovarianceTrack(Kernel kernel, double interval_s)
      : kernel_(std::move(kernel)), interval_s_(interval_s) {}

  /// Whether the kernel is at the present. Phi then begins here: what holds for the whole of it may
  /// be taken anew.
  bool is_current() const { return is_current_; }

  /// Whether Phi has not begun to follow the motion.
  bool is_at_start_of_phi() const { return Phi_.dt_s == 0.0; }

  /// Takes the increment into the kernel at once, without a Phi, where that comes to the same.
  /// @returns whether it has done so
  bool propagate_at_once(const ErrorDynamics& dynamics, const ProcessNoise& noise) {
    if constexpr (requires { kernel_.propagate(dynamics, noise); }) {
      if (interval_s_ == 0.0 && is_current_) {
        kernel_.propagate(dynamics, noise);
        return true;
      }
    }
    return false;
  }

  /// Takes the increment into Phi.
  /// @returns whether the interval has passed, and flush() is due
  bool extend(const ErrorDynamics& dynamics) {
    advance(Phi_, dynamics);
    is_current_ = false;
    // Half an increment of slack, so that rounding does not shift the moment.
    return Phi_.dt_s + 0.5 * dynamics.dt_s > interval_s_;
  }

  /// Brings the kernel up to the present. @returns the Phi that did
  Transition flush(const ProcessNoise& noise) {
    kernel_.propagate(Phi_, noise);
    is_current_ = true;
    return std::exchange(Phi_, Transition{});
  }

  /// One increment, in whichever way.
  void propagate(const ErrorDynamics& dynamics, const ProcessNoise& noise) {
    if (!propagate_at_once(dynamics, noise) && extend(dynamics)) flush(noise);
  }

  /// What a correction makes of the error that remains, as the first factor of the next Phi: no
  /// kernel need know of it, and it costs none a propagation. @pre is_current()
  void reset_by(const Transition& reset) {
    Phi_ = reset;
    is_current_ = false;
  }

  /// Puts another covariance in place, at present.
  void set(const ErrorMatrix& P) requires SettableKernel<Kernel> {
    kernel_.set(P);
    Phi_ = Transition{};
    is_current_ = true;
  }

  Kernel& kernel() { return kernel_; }
  const Kernel& kernel() const { return kernel_; }

  /// Covariance at present. Reading it changes nothing.
  ErrorMatrix matrix(const ProcessNoise& noise) const {
    if (is_current_) return kernel_.matrix();
    CovarianceTrack present = *this;
    present.flush(noise);
    return present.kernel_.matrix();
  }

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(kernel_, Phi_, is_current_);
  }

 private:
  Kernel kernel_;
  double interval_s_;
  Transition Phi_{};
  bool is_current_{true};  // Phi_ is the identity
};

}  // namespace leeway
