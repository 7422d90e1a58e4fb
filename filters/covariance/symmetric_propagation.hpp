/// @file
/// Phi P Phi^T for a Phi that only changes attitude, velocity and position, and scales the biases.
/// The same rows of Phi act twice: on the columns of P, which are its rows, and, after a transpose
/// within registers, on the rows of what came of it. The second time only the lower half is formed.
#pragma once

#include "filters/covariance/increment_transition.hpp"
#include "filters/covariance/lanes.hpp"
#include "leeway/covariance/covariance_kernel.hpp"
#include "leeway/model/error_state.hpp"

namespace leeway::lanes {

inline constexpr int kMotionStates = kBa;  // attitude, velocity, position: what Phi mixes

/// The part of the diagonal noise that is added on each side, and what the biases are scaled by.
/// Single numbers, not lanes: a load of lanes just stored one by one would wait for the stores.
template <class Scalar>
struct Diagonal {
  ErrorVector noise;
  Scalar a_a;
  Scalar g_g;

  Scalar noise_of(int i) const { return static_cast<Scalar>(noise(i)); }
  Scalar decay(int bias) const { return bias < kBg ? a_a : g_g; }

  /// For a block of rows from `start` on; means nothing for the motion's.
  [[gnu::always_inline]] VectorOf<Scalar> decay_from(int start) const {
    return first_of<Scalar>(kBg - start, VectorOf<Scalar>{} + a_a, VectorOf<Scalar>{} + g_g);
  }
};

/// W^T = (P + noise) Phi^T, its columns in blocks of lanes.
template <class Scalar, int N>
using Transported = Array<Blocks<Scalar, N>, kMotionStates>;

template <class Scalar, int N, class Rows>
[[gnu::always_inline]] inline Transported<Scalar, N> transported(
    const Eigen::Matrix<Scalar, N, N>& P, const Rows& rows, const Diagonal<Scalar>& diagonal) {
  Transported<Scalar, N> W;
  unrolled<kBlocks<Scalar, N>>([&](auto block) __attribute__((always_inline)) {
    constexpr int kStart = start_of<Scalar, N>(block);
    Column<Scalar> in;
    unrolled<kErrorStates>([&](auto k) __attribute__((always_inline)) {
      in[k] = load(P.data() + N * k + kStart);
      if constexpr (k >= kStart && k < kStart + kCount<Scalar>) {
        in[k] += only<Scalar>(k - kStart, VectorOf<Scalar>{} + diagonal.noise_of(k));
      }
    });
    Column<Scalar> out;
    rows.attitude(in, out);
    rows.velocity(in, out);
    rows.position(in, out);
    unrolled<kMotionStates>([&](auto i) __attribute__((always_inline)) { W[i][block] = out[i]; });
  });
  return W;
}

/// Columns of W from its rows `first` on.
template <int first, class Scalar, int N>
[[gnu::always_inline]] inline Column<Scalar> columns_of(const Transported<Scalar, N>& W) {
  Column<Scalar> columns;
  unrolled<kBlocks<Scalar, N>>([&](auto block) __attribute__((always_inline)) {
    Square<Scalar> square;
    unrolled<kCount<Scalar>>([&](auto i) __attribute__((always_inline)) {
      square[i] = W[first + i][block];
    });
    transpose<Scalar>(square);
    unrolled<kCount<Scalar>>([&](auto k) __attribute__((always_inline)) {
      columns[start_of<Scalar, N>(block) + k] = square[k];
    });
  });
  return columns;
}

/// The covariance of the biases with the motion, below the motion's columns.
template <class Scalar, int N>
[[gnu::always_inline]] inline void store_bias_rows(Eigen::Matrix<Scalar, N, N>& P,
                                                   const Transported<Scalar, N>& W,
                                                   const Diagonal<Scalar>& diagonal) {
  unrolled<kBlocks<Scalar, N>>([&](auto block) __attribute__((always_inline)) {
    constexpr int kStart = start_of<Scalar, N>(block);
    if constexpr (kStart + kCount < Scalar >> kBa) {
      const VectorOf<Scalar> decay = diagonal.decay_from(kStart);
      // Rows of the motion in the same block are written over by store_motion_rows().
      unrolled<kMotionStates>([&](auto i) __attribute__((always_inline)) {
        store<Scalar>(P.data() + N * i + kStart, decay * W[i][block]);
      });
    }
  });
}

/// Rows `first` to `end` of P = W Phi^T: as much of the motion's columns as the lower half needs,
/// and the columns of the biases.
template <int first, int end, class Scalar, int N, class Rows>
[[gnu::always_inline]] inline void store_motion_rows(Eigen::Matrix<Scalar, N, N>& P,
                                                     const Transported<Scalar, N>& W,
                                                     const Rows& rows,
                                                     const Diagonal<Scalar>& diagonal) {
  const Column<Scalar> in = columns_of<first, Scalar, N>(W);
  Column<Scalar> out;
  rows.attitude(in, out);
  if constexpr (end > kDv) rows.velocity(in, out);
  if constexpr (end > kDr) rows.position(in, out);
  unrolled<kErrorStates>([&](auto j) __attribute__((always_inline)) {
    Scalar* to = P.data() + N * j + first;
    if constexpr (j < end) store<Scalar>(to, out[j]);
    if constexpr (j >= kBa) store<Scalar>(to, diagonal.decay(j) * in[j]);
  });
}

template <class Scalar, int N>
void store_biases(Eigen::Matrix<Scalar, N, N>& P, const Diagonal<Scalar>& diagonal) {
  for (int j = kBa; j < kErrorStates; ++j) {
    P(j, j) += diagonal.noise_of(j);
    if (diagonal.a_a == 1 && diagonal.g_g == 1) continue;
    for (int i = kBa; i < kErrorStates; ++i) P(i, j) *= diagonal.decay(i) * diagonal.decay(j);
  }
}

/// P <- Phi (P + noise) Phi^T + noise, symmetric to the bit.
/// @param rows  the rows of Phi: attitude(), velocity(), position() form theirs from all 15 lanes;
///              velocity() may use what attitude() gave, position() what velocity() gave
template <class Scalar, int N, class Rows>
void propagate_symmetric(Eigen::Matrix<Scalar, N, N>& P, const Rows& rows,
                         const Diagonal<Scalar>& diagonal) {
  const Transported<Scalar, N> W = transported<Scalar, N>(P, rows, diagonal);
  store_bias_rows<Scalar, N>(P, W, diagonal);
  // Blocks of rows that start at each triad, moved back where they would reach into the biases.
  constexpr int kBlocksInTriad = kBlocks<Scalar, 3>;
  constexpr int kLastFirst = kMotionStates - kCount<Scalar>;
  unrolled<3 * kBlocksInTriad>([&](auto n) __attribute__((always_inline)) {
    constexpr int kTriad = 3 * (n / kBlocksInTriad);
    constexpr int kFirst = kTriad + n % kBlocksInTriad * kCount<Scalar>;
    store_motion_rows<(kFirst < kLastFirst ? kFirst : kLastFirst), kTriad + 3, Scalar, N>(
        P, W, rows, diagonal);
  });
  for (int j = 0; j < kMotionStates; ++j) {
    for (int i = j + 1; i < kMotionStates; ++i) P(j, i) = P(i, j);
  }
  store_biases<Scalar, N>(P, diagonal);
  for (int i = 0; i < kErrorStates; ++i) P(i, i) += diagonal.noise_of(i);
}

}  // namespace leeway::lanes
