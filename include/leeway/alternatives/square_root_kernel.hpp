/// @file
/// The covariance as P = S S^T, S upper triangular. P is positive semidefinite whatever the
/// rounding; the dynamic range of its numbers is halved.
#pragma once

#include "leeway/covariance/covariance_kernel.hpp"

namespace leeway {

/// Time update: Householder's triangularization of (Phi S, Phi G, G), the noise as 24 columns, half
/// before Phi and half after: the very formula of propagate(). Measurement: Carlson.
/// Source: Carlson (1973); Maybeck (1979), 7.4 and 7.5; Grewal and Andrews (2015), 7.5.
/// Instantiated for float, double and long double.
template <class Scalar>
class SquareRootKernel {
 public:
  using Number = Scalar;

  /// @pre P is symmetric positive semidefinite.
  explicit SquareRootKernel(const ErrorMatrix& P);
  ErrorMatrix matrix() const;
  void propagate(const Transition& Phi, const ProcessNoise& noise);
  double update(ErrorVector& x_hat, const ErrorVector& h, double z);
  double update(ErrorVector& x_hat, const MeasurementRows& H, const MeasurementValues& z) {
    return update_in_sequence(*this, x_hat, H, z);
  }

 private:
  CovarianceMatrix<Scalar> S_;
};

}  // namespace leeway
