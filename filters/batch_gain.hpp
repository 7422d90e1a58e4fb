/// @file
/// A whole measurement at once, by the Cholesky factor of the innovation's covariance.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "leeway/filters/covariance_kernel.hpp"
#include "leeway/filters/error_state.hpp"

namespace leeway {

/// S = H P H^T + 1 = L L^T. P loses V V^T, V = P H^T L^-T. Columns from `rows` on are not set.
template <class Scalar, int N>
using BatchFactor = Eigen::Matrix<Scalar, N, kMaxRows>;

/// Moves x_hat by the measurement and returns V. P may have rows beyond the 15, of zeros.
template <class Scalar, int N>
BatchFactor<Scalar, N> batch_gain(const Eigen::Matrix<Scalar, N, N>& P, ErrorVector& x_hat,
                                  const MeasurementRows& H, const MeasurementValues& z) {
  const int rows = static_cast<int>(H.rows());
  BatchFactor<Scalar, N> V;
  Eigen::Matrix<Scalar, kMaxRows, kMaxRows> L;
  Eigen::Matrix<Scalar, kMaxRows, 1> white;
  for (int i = 0; i < rows; ++i) {
    Eigen::Matrix<Scalar, N, 1> h = Eigen::Matrix<Scalar, N, 1>::Zero();
    for (int k = 0; k < kErrorStates; ++k) h(k) = static_cast<Scalar>(H(i, k));
    V.col(i) = P.lazyProduct(h);
    white(i) = static_cast<Scalar>(z(i) - H.row(i).dot(x_hat));
    for (int j = 0; j <= i; ++j) L(i, j) = h.dot(V.col(j));
    L(i, i) += 1;
  }
  // V <- V L^-T and white <- L^-1 white, as L is found column by column.
  for (int j = 0; j < rows; ++j) {
    const Scalar inverse = 1 / std::sqrt(L(j, j));
    for (int i = j; i < rows; ++i) L(i, j) *= inverse;
    V.col(j) *= inverse;
    white(j) *= inverse;
    for (int i = j + 1; i < rows; ++i) {
      for (int k = j + 1; k <= i; ++k) L(i, k) -= L(i, j) * L(k, j);
      V.col(i) -= L(i, j) * V.col(j);
      white(i) -= L(i, j) * white(j);
    }
  }
  for (int i = 0; i < rows; ++i) {
    x_hat += (white(i) * V.col(i).template head<kErrorStates>()).template cast<double>();
  }
  return V;
}

}  // namespace leeway
