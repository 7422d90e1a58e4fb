/// @file
/// P = U D U^T from P.
#pragma once

#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/model/error_state.hpp"

namespace leeway {

template <class Scalar>
struct UdFactors {
  CovarianceMatrix<Scalar> U;
  CovarianceVector<Scalar> D;
};

/// From the last column backwards. Where P is singular an element of D is 0 and its column of U
/// that of the identity. Source: Bierman (1977), III.4.
template <class Scalar>
UdFactors<Scalar> ud_factors(const ErrorMatrix& P) {
  CovarianceMatrix<Scalar> left = P.cast<Scalar>();
  UdFactors<Scalar> factors{CovarianceMatrix<Scalar>::Identity(), {}};
  for (int j = kErrorStates - 1; j >= 0; --j) {
    const Scalar pivot = left(j, j);
    factors.D(j) = pivot > 0 ? pivot : Scalar{0};
    if (!(pivot > 0)) continue;
    for (int i = 0; i < j; ++i) factors.U(i, j) = left(i, j) / pivot;
    for (int k = 0; k < j; ++k) {
      for (int i = 0; i <= k; ++i) left(i, k) -= factors.U(i, j) * factors.U(k, j) * pivot;
    }
  }
  return factors;
}

}  // namespace leeway
