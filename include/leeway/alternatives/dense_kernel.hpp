/// @file
/// The covariance as the books write it, every product in full: what the others are tested and
/// timed against.
#pragma once

#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {

/// Nothing is mirrored or symmetrized: rounding shows. Source: Groves (2013) (3.46), (3.21),
/// (3.23); Joseph's form (3.24). Instantiated for float, double and long double.
template <class Scalar>
class DenseKernel {
 public:
  using Number = Scalar;

  explicit DenseKernel(const ErrorMatrix& P, UpdateForm form = UpdateForm::kJoseph)
      : P_(P.cast<Scalar>()), form_(form) {}

  ErrorMatrix matrix() const { return P_.template cast<double>(); }

  /// In the kernel's own precision.
  const CovarianceMatrix<Scalar>& exact() const { return P_; }

  void propagate(const Transition& Phi, const ProcessNoise& noise);
  /// With UpdateForm::kBatch a single row is taken by the simple form, which is the same.
  double update(ErrorVector& x_hat, const ErrorVector& h, double z);
  double update(ErrorVector& x_hat, const MeasurementRows& H, const MeasurementValues& z);

 private:
  CovarianceMatrix<Scalar> P_;
  UpdateForm form_;
};

}  // namespace leeway
