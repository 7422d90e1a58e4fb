/// @file
/// The covariance as P = U D U^T, U unit upper triangular, D diagonal. P cannot lose symmetry, and
/// is positive as long as no element of D turns negative, which no step of these can make it.
#pragma once

#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {

/// Time update: Thornton's modified weighted Gram-Schmidt, with the noise as 24 columns, half
/// before Phi and half after: the very formula of propagate(). Measurement: Bierman.
/// Source: Thornton (1976); Bierman (1977), chapters V and VI; Grewal and Andrews (2015), 7.6.
/// Instantiated for float, double and long double.
template <class Scalar>
class UdKernel {
 public:
  using Number = Scalar;

  /// @pre P is symmetric positive semidefinite.
  explicit UdKernel(const ErrorMatrix& P);
  ErrorMatrix matrix() const;
  void propagate(const Transition& Phi, const ProcessNoise& noise);
  double update(ErrorVector& x_hat, const ErrorVector& h, double z);
  double update(ErrorVector& x_hat, const MeasurementRows& H, const MeasurementValues& z) {
    return update_in_sequence(*this, x_hat, H, z);
  }

 private:
  CovarianceMatrix<Scalar> U_;
  CovarianceVector<Scalar> D_;
};

}  // namespace leeway
