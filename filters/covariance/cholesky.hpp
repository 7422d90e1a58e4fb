/// @file
/// Cholesky factors of small symmetric matrices, by plain loops over fixed storage. Eigen's own is
/// made for any size: at these it takes longer to run, and far longer to compile.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace leeway {

/// A = L L^T of at most N rows.
template <int N>
class Cholesky {
 public:
  /// @param A  square, symmetric; the lower half is read
  template <class Matrix>
  explicit Cholesky(const Matrix& A) : rows_(static_cast<int>(A.rows())) {
    for (int j = 0; j < rows_ && positive_; ++j) {
      double pivot = A(j, j);
      for (int k = 0; k < j; ++k) pivot -= at(j, k) * at(j, k);
      positive_ = pivot > 0.0;
      at(j, j) = std::sqrt(pivot);
      for (int i = j + 1; i < rows_; ++i) {
        double sum = A(i, j);
        for (int k = 0; k < j; ++k) sum -= at(i, k) * at(j, k);
        at(i, j) = sum / at(j, j);
      }
    }
  }

  /// Whether A is positive definite; the rest is only for one that is.
  bool positive() const { return positive_; }

  double log_det() const {
    double sum = 0.0;
    for (int i = 0; i < rows_; ++i) sum += std::log(at(i, i));
    return 2.0 * sum;
  }

  /// The first rows of B, as many as A has, become those of L^-1 B.
  template <class Rows>
  void whiten(Rows&& B) const {
    for (int i = 0; i < rows_; ++i) {
      for (int k = 0; k < i; ++k) {
        if (at(i, k) != 0.0) B.row(i) -= at(i, k) * B.row(k);
      }
      B.row(i) *= 1.0 / at(i, i);
    }
  }

  /// L^-1 B.
  template <class Matrix>
  Matrix whitened(Matrix B) const {
    whiten(B);
    return B;
  }

  /// v^T A^-1 v.
  template <class Vector>
  double normalized_square(const Vector& v) const {
    return whitened(v).squaredNorm();
  }

 private:
  double& at(int i, int j) { return L_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]; }
  double at(int i, int j) const {
    return L_[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  }

  std::array<std::array<double, N>, N> L_{};
  int rows_;
  bool positive_{true};
};

}  // namespace leeway
