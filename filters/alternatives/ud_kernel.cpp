#include "leeway/alternatives/ud_kernel.hpp"

#include <limits>

#include "filters/alternatives/ud_factors.hpp"
#include "filters/covariance/factored_propagation.hpp"
#include "filters/covariance/lanes.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {

template <class Scalar>
UdKernel<Scalar>::UdKernel(const ErrorMatrix& P) {
  const UdFactors<Scalar> factors = ud_factors<Scalar>(P);
  U_ = factors.U;
  D_ = factors.D;
}

template <class Scalar>
ErrorMatrix UdKernel<Scalar>::matrix() const {
  const ErrorMatrix U = U_.template cast<double>();
  const ErrorVector D = D_.template cast<double>();
  ErrorMatrix P;
  for (int j = 0; j < kErrorStates; ++j) {
    for (int i = 0; i <= j; ++i) {
      double sum = 0.0;
      for (int k = j; k < kErrorStates; ++k) sum += U(i, k) * D(k) * U(j, k);
      P(i, j) = P(j, i) = sum;
    }
  }
  return P;
}

template <class Scalar>
void UdKernel<Scalar>::propagate(const Transition& Phi, const ProcessNoise& noise) {
  using lanes::kWeightedColumns;
  auto [W, weight] = lanes::weighted_columns<Scalar>(Phi, noise, U_, D_);
  for (int j = kErrorStates - 1; j >= 0; --j) {
    typename lanes::WeightedColumns<Scalar>::Row weighted;
    for (int k = 0; k < kWeightedColumns; ++k) weighted[k] = weight[k] * W[j][k];
    D_(j) = lanes::dot<Scalar>(weighted, W[j], kWeightedColumns);
    // The inverse of a number below the smallest normal one may be infinite.
    const bool has_inverse = D_(j) >= std::numeric_limits<Scalar>::min();
    const Scalar inverse = has_inverse ? 1 / D_(j) : Scalar{0};
    for (int i = 0; i < j; ++i) {
      U_(i, j) = inverse * lanes::dot<Scalar>(weighted, W[i], kWeightedColumns);
      lanes::add_scaled<Scalar>(W[i], -U_(i, j), W[j], kWeightedColumns);
    }
  }
}

template <class Scalar>
double UdKernel<Scalar>::update(ErrorVector& x_hat, const ErrorVector& h, double z) {
  CovarianceVector<Scalar> gain = CovarianceVector<Scalar>::Zero();  // times the variance so far
  Scalar variance = 1;
  for (int j = 0; j < kErrorStates; ++j) {
    Scalar f = static_cast<Scalar>(h(j));
    for (int i = 0; i < j; ++i) f += U_(i, j) * static_cast<Scalar>(h(i));
    const Scalar v = D_(j) * f;
    const Scalar before = variance;
    variance += f * v;
    D_(j) *= before / variance;
    const Scalar lambda = -f / before;
    for (int i = 0; i < j; ++i) {
      const Scalar u = U_(i, j);
      U_(i, j) += gain(i) * lambda;
      gain(i) += u * v;
    }
    gain(j) = v;
  }
  const double innovation = z - h.dot(x_hat);
  x_hat += innovation / static_cast<double>(variance) * gain.template cast<double>();
  return static_cast<double>(variance);
}

template class UdKernel<float>;
template class UdKernel<double>;
template class UdKernel<long double>;

}  // namespace leeway
