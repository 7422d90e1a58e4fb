#include "leeway/filters/dense_kernel.hpp"

#include "batch_gain.hpp"
#include "leeway/filters/error_state.hpp"

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
void DenseKernel<Scalar>::update(ErrorVector& x_hat, const MeasurementRows& H,
                                 const MeasurementValues& z) {
  if (form_ != UpdateForm::kBatch) {
    update_in_sequence(*this, x_hat, H, z);
    return;
  }
  const BatchFactor<Scalar, kErrorStates> V = batch_gain<Scalar, kErrorStates>(P_, x_hat, H, z);
  for (int i = 0; i < H.rows(); ++i) P_ -= V.col(i) * V.col(i).transpose();
}

template class DenseKernel<float>;
template class DenseKernel<double>;
template class DenseKernel<long double>;

}  // namespace leeway
