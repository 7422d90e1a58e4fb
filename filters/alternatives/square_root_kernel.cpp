#include "leeway/alternatives/square_root_kernel.hpp"

#include <cmath>
#include <limits>

#include "filters/alternatives/ud_factors.hpp"
#include "filters/covariance/factored_propagation.hpp"
#include "filters/covariance/lanes.hpp"

namespace leeway {

template <class Scalar>
SquareRootKernel<Scalar>::SquareRootKernel(const ErrorMatrix& P) {
  const UdFactors<Scalar> factors = ud_factors<Scalar>(P);
  for (int j = 0; j < kErrorStates; ++j) S_.col(j) = std::sqrt(factors.D(j)) * factors.U.col(j);
}

template <class Scalar>
ErrorMatrix SquareRootKernel<Scalar>::matrix() const {
  const ErrorMatrix S = S_.template cast<double>();
  ErrorMatrix P;
  for (int j = 0; j < kErrorStates; ++j) {
    for (int i = 0; i <= j; ++i) {
      double sum = 0.0;
      for (int k = j; k < kErrorStates; ++k) sum += S(i, k) * S(j, k);
      P(i, j) = P(j, i) = sum;
    }
  }
  return P;
}

template <class Scalar>
void SquareRootKernel<Scalar>::propagate(const Transition& Phi, const ProcessNoise& noise) {
  using lanes::kFactorColumn;
  auto [W, weight] =
      lanes::weighted_columns<Scalar>(Phi, noise, S_, CovarianceVector<Scalar>::Ones());
  for (int k = 0; k < kFactorColumn; ++k) {
    const Scalar sigma = std::sqrt(weight[k]);
    for (int i = 0; i < kErrorStates; ++i) W[i][k] *= sigma;
  }
  S_.setZero();
  // From the last row backwards, a reflection turns what is left of a row into its last element.
  for (int i = kErrorStates - 1; i >= 0; --i) {
    const int pivot = kFactorColumn + i;
    for (int k = pivot + 1; k < lanes::kWeightedColumns; ++k) W[i][k] = 0;
    const Scalar norm = std::sqrt(lanes::dot<Scalar>(W[i], W[i], pivot + 1));
    const Scalar last = W[i][pivot];
    S_(i, i) = last > 0 ? -norm : norm;
    W[i][pivot] -= S_(i, i);
    // Below the smallest normal number there is nothing to reflect, and no finite inverse.
    const Scalar square = norm * (norm + std::abs(last));
    const Scalar inverse = square >= std::numeric_limits<Scalar>::min() ? 1 / square : Scalar{0};
    for (int j = 0; j < i; ++j) {
      const Scalar share = inverse * lanes::dot<Scalar>(W[i], W[j], pivot + 1);
      lanes::add_scaled<Scalar>(W[j], -share, W[i], pivot + 1);
      S_(j, i) = W[j][pivot];
    }
  }
}

template <class Scalar>
double SquareRootKernel<Scalar>::update(ErrorVector& x_hat, const ErrorVector& h, double z) {
  CovarianceVector<Scalar> gain = CovarianceVector<Scalar>::Zero();  // times the variance so far
  Scalar variance = 1;
  for (int j = 0; j < kErrorStates; ++j) {
    Scalar f = 0;
    for (int i = 0; i <= j; ++i) f += S_(i, j) * static_cast<Scalar>(h(i));
    const Scalar before = variance;
    variance += f * f;
    const Scalar keep = std::sqrt(before / variance);
    const Scalar give = f * keep / before;
    for (int i = 0; i <= j; ++i) {
      const Scalar s = S_(i, j);
      S_(i, j) = keep * s - give * gain(i);
      gain(i) += f * s;
    }
  }
  const double innovation = z - h.dot(x_hat);
  x_hat += innovation / static_cast<double>(variance) * gain.template cast<double>();
  return static_cast<double>(variance);
}

template class SquareRootKernel<float>;
template class SquareRootKernel<double>;
template class SquareRootKernel<long double>;

}  // namespace leeway
