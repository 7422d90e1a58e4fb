/// @file
/// Phi (P + Q/2) Phi^T + Q/2 for a P in factors: the same as W diag(weight) W^T, with W the columns
/// of Phi times the factor, of Phi for the noise before and of the identity for the noise after.
/// Triangularizing W gives the new factor.
#pragma once

#include "filters/covariance/lanes.hpp"
#include "leeway/covariance/covariance.hpp"
#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/covariance/transition.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway::lanes {

inline constexpr int kNoises = 12;  // attitude, velocity and both biases
/// Noise before, noise after and the factor; the last column is zero, for whole blocks of lanes.
inline constexpr int kFactorColumn = 2 * kNoises;
inline constexpr int kWeightedColumns = kFactorColumn + kErrorStates + 1;

template <class Scalar>
struct WeightedColumns {
  using Row = Array<Scalar, kWeightedColumns>;
  Array<Row, kErrorStates> W;  // its rows, which triangularization works on
  Row weight;
};

/// sum of a * b over the first columns, `count` rounded up to whole blocks.
template <class Scalar>
Scalar dot(const Array<Scalar, kWeightedColumns>& a, const Array<Scalar, kWeightedColumns>& b,
           int count) {
  VectorOf<Scalar> sum{};
  for (int k = 0; k < count; k += kCount<Scalar>) sum += load(&a[k]) * load(&b[k]);
  return total<Scalar>(sum);
}

/// a += factor * b over the first columns, `count` rounded up to whole blocks.
template <class Scalar>
void add_scaled(Array<Scalar, kWeightedColumns>& a, Scalar factor,
                const Array<Scalar, kWeightedColumns>& b, int count) {
  for (int k = 0; k < count; k += kCount<Scalar>) {
    store<Scalar>(&a[k], load(&a[k]) + factor * load(&b[k]));
  }
}

/// @param factor         upper triangular
/// @param factor_weight  weights of its columns
template <class Scalar>
WeightedColumns<Scalar> weighted_columns(const Transition& Phi, const ProcessNoise& noise,
                                         const CovarianceMatrix<Scalar>& factor,
                                         const CovarianceVector<Scalar>& factor_weight) {
  WeightedColumns<Scalar> result;
  const auto set = [&](int column, const CovarianceVector<Scalar>& values, Scalar weight) {
    for (int i = 0; i < kErrorStates; ++i) result.W[i][column] = values(i);
    result.weight[column] = weight;
  };
  const ErrorVector half_q = noise_variance(noise, 0.5 * Phi.dt_s);
  int column = 0;
  for (const int first : {kPsi, kDv, kBa, kBg}) {
    for (int i = first; i < first + 3; ++i) {
      const CovarianceVector<Scalar> unit = CovarianceVector<Scalar>::Unit(i);
      set(column++, times(Phi, unit), static_cast<Scalar>(half_q(i)));
      set(column++, unit, static_cast<Scalar>(half_q(i)));
    }
  }
  for (int j = 0; j < kErrorStates; ++j) {
    const CovarianceVector<Scalar> values = factor.col(j);
    set(kFactorColumn + j, times(Phi, values), factor_weight(j));
  }
  set(kWeightedColumns - 1, CovarianceVector<Scalar>::Zero(), 0);
  return result;
}

}  // namespace leeway::lanes
