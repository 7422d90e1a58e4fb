// Compiled with -ffp-contract=off: the two places that form A = P - d d^T must round it alike.
#include "symmetric_update.hpp"

#include <Eigen/Core>
#include <cmath>

#include "lanes.hpp"
#include "leeway/filters/symmetric_kernel.hpp"
#include "leeway/filters/vehicle_state.hpp"

namespace leeway {

using lanes::VectorOf;

template <class Scalar, int N>
ScalarGain<Scalar, N> update_symmetric(Eigen::Matrix<Scalar, N, N>& P,
                                       const Eigen::Matrix<Scalar, N, 1>& h, UpdateForm form) {
  using lanes::each_block;
  using lanes::load;
  using lanes::store;
  using Blocks = lanes::Blocks<Scalar, N>;
  lanes::Array<int, N> observed;
  int count = 0;
  for (int k = 0; k < N; ++k) {
    if (h(k) != 0) observed[count++] = k;
  }

  Blocks u;  // P h
  each_block<Scalar, N>([&](int b, int) { u[b] = VectorOf<Scalar>{}; });
  for (int n = 0; n < count; ++n) {
    const Scalar* column = P.data() + N * observed[n];
    const Scalar h_k = h(observed[n]);
    each_block<Scalar, N>([&](int b, int row) { u[b] += h_k * load(column + row); });
  }
  ScalarGain<Scalar, N> gain;
  Eigen::Matrix<Scalar, N, 1> Ph;
  each_block<Scalar, N>([&](int b, int row) { store<Scalar>(Ph.data() + row, u[b]); });
  Scalar variance = 1;
  for (int n = 0; n < count; ++n) variance += h(observed[n]) * Ph(observed[n]);
  gain.variance = variance;
  // P h / s = K = c d with d = c P h: d d^T is symmetric to the bit, K (P h)^T is not.
  const Scalar c = 1 / std::sqrt(variance);
  Blocks d;
  Blocks K;
  Eigen::Matrix<Scalar, N, 1> d_of;
  each_block<Scalar, N>([&](int b, int row) {
    d[b] = c * u[b];
    K[b] = c * d[b];
    store<Scalar>(d_of.data() + row, d[b]);
    store<Scalar>(gain.K.data() + row, K[b]);
  });
  if (form != UpdateForm::kJoseph) {
    lanes::change_symmetric<Scalar, N>(
        P, [&](int j, int b, const VectorOf<Scalar>& old) { return old - d_of(j) * d[b]; });
    return gain;
  }

  // What rounding made of A = P - d d^T shows in A h, which should be K. Taken out along K on both
  // sides, as Joseph's form does with every error of P:
  // A - r K^T - K q^T, r = A h - K, q = r - K (h r).
  Blocks r;
  each_block<Scalar, N>([&](int b, int) { r[b] = -K[b]; });
  for (int n = 0; n < count; ++n) {
    const Scalar* column = P.data() + N * observed[n];
    const Scalar h_k = h(observed[n]);
    const Scalar d_k = d_of(observed[n]);
    each_block<Scalar, N>([&](int b, int row) { r[b] += h_k * (load(column + row) - d_k * d[b]); });
  }
  Eigen::Matrix<Scalar, N, 1> q_of;
  each_block<Scalar, N>([&](int b, int row) { store<Scalar>(q_of.data() + row, r[b]); });
  Scalar h_r = 0;
  for (int n = 0; n < count; ++n) h_r += h(observed[n]) * q_of(observed[n]);
  each_block<Scalar, N>(
      [&](int b, int row) { store<Scalar>(q_of.data() + row, r[b] - h_r * K[b]); });
  lanes::change_symmetric<Scalar, N>(P, [&](int j, int b, const VectorOf<Scalar>& old) {
    return (old - d_of(j) * d[b]) - gain.K(j) * r[b] - q_of(j) * K[b];
  });
  return gain;
}

#define LEEWAY_INSTANTIATE(Scalar, N)                         \
  template ScalarGain<Scalar, N> update_symmetric<Scalar, N>( \
      Eigen::Matrix<Scalar, N, N>&, const Eigen::Matrix<Scalar, N, 1>&, UpdateForm)
LEEWAY_INSTANTIATE(float, kPaddedStates);
LEEWAY_INSTANTIATE(double, kPaddedStates);
LEEWAY_INSTANTIATE(long double, kPaddedStates);
LEEWAY_INSTANTIATE(double, kErrorStates);
LEEWAY_INSTANTIATE(double, kJointStates);
#undef LEEWAY_INSTANTIATE

}  // namespace leeway
