#include "leeway/alternatives/dense_kernel.hpp"

#include <cmath>

#include "leeway/model/error_state.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {
namespace {

template <class Scalar>
using Matrix = CovarianceMatrix<Scalar>;

template <class Scalar>
Matrix<Scalar> product(const Matrix<Scalar>& a, const Matrix<Scalar>& b) {
  Matrix<Scalar> c = Matrix<Scalar>::Zero();
  for (int j = 0; j < kErrorStates; ++j) {
    for (int k = 0; k < kErrorStates; ++k) c.col(j) += b(k, j) * a.col(k);
  }
  return c;
}

template <class Scalar>
Matrix<Scalar> triple_product(const Matrix<Scalar>& a, const Matrix<Scalar>& b) {
  const Matrix<Scalar> a_transposed = a.transpose();
  return product<Scalar>(product<Scalar>(a, b), a_transposed);
}

/// S = H P H^T + 1 = L L^T. P loses V V^T, V = P H^T L^-T. Columns from `rows` on are not set.
template <class Scalar>
using BatchFactor = Eigen::Matrix<Scalar, kErrorStates, kMaxRows>;

template <class Scalar>
struct BatchGain {
  BatchFactor<Scalar> V;
  Scalar nis;
};

/// Moves x_hat by the measurement.
template <class Scalar>
BatchGain<Scalar> batch_gain(const Matrix<Scalar>& P, ErrorVector& x_hat, const MeasurementRows& H,
                             const MeasurementValues& z) {
  const int rows = static_cast<int>(H.rows());
  BatchGain<Scalar> gain{BatchFactor<Scalar>::Zero(), 0};
  auto& V = gain.V;
  Eigen::Matrix<Scalar, kMaxRows, kMaxRows> L;
  Eigen::Matrix<Scalar, kMaxRows, 1> white = Eigen::Matrix<Scalar, kMaxRows, 1>::Zero();
  for (int i = 0; i < rows; ++i) {
    const CovarianceVector<Scalar> h = H.row(i).transpose().template cast<Scalar>();
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
    x_hat += (white(i) * V.col(i)).template cast<double>();
    gain.nis += white(i) * white(i);
  }
  return gain;
}

}  // namespace

template <class Scalar>
void DenseKernel<Scalar>::propagate(const Transition& Phi, const ProcessNoise& noise) {
  const CovarianceVector<Scalar> half_q = noise_variance(noise, 0.5 * Phi.dt_s).cast<Scalar>();
  P_.diagonal() += half_q;
  P_ = triple_product<Scalar>(dense(Phi).template cast<Scalar>(), P_);
  P_.diagonal() += half_q;
}

template <class Scalar>
double DenseKernel<Scalar>::update(ErrorVector& x_hat, const ErrorVector& h, double z) {
  const auto& row = h.cast<Scalar>();
  const CovarianceVector<Scalar> Ph = P_.lazyProduct(row);
  const Scalar variance = row.dot(Ph) + 1;
  const CovarianceVector<Scalar> K = Ph / variance;
  const Matrix<Scalar> left = Matrix<Scalar>::Identity() - K * row.transpose();
  if (form_ == UpdateForm::kJoseph) {
    P_ = triple_product<Scalar>(left, P_) + K * K.transpose();
  } else {
    P_ = product<Scalar>(left, P_);
  }
  x_hat += (z - h.dot(x_hat)) * K.template cast<double>();
  return static_cast<double>(variance);
}

template <class Scalar>
double DenseKernel<Scalar>::update(ErrorVector& x_hat, const MeasurementRows& H,
                                   const MeasurementValues& z) {
  if (form_ != UpdateForm::kBatch) return update_in_sequence(*this, x_hat, H, z);
  const auto [V, nis] = batch_gain<Scalar>(P_, x_hat, H, z);
  for (int i = 0; i < H.rows(); ++i) P_ -= V.col(i) * V.col(i).transpose();
  return static_cast<double>(nis);
}

template class DenseKernel<float>;
template class DenseKernel<double>;
template class DenseKernel<long double>;

}  // namespace leeway
