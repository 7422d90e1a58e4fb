/// @file
/// Changes of a symmetric matrix by outer products: the lower half computed, the upper its mirror,
/// block by block in registers.
#pragma once

#include <Eigen/Core>

#include "lanes.hpp"

namespace leeway::lanes {

/// Replaces the lower half of P by what `changed` makes of it, and the upper half by its mirror.
/// @param changed  from a column, a block of rows and their present lanes, the lanes to be
template <class Scalar, int N, class F>
[[gnu::always_inline]] inline void change_symmetric(Eigen::Matrix<Scalar, N, N>& P,
                                                    const F& changed) {
  constexpr int kLast = kBlocks<Scalar, N> - 1;
  // How many lanes of the last block the one before it has dealt with.
  constexpr int kDone = (kLast + 1) * kCount<Scalar> - N;
  unrolled<(kLast + 1) * (kLast + 1)>([&](auto n) __attribute__((always_inline)) {
    constexpr int kRows = n % (kLast + 1);
    constexpr int kColumns = n / (kLast + 1);
    if constexpr (kRows >= kColumns) {
      constexpr int kRow = start_of<Scalar, N>(kRows);
      constexpr int kColumn = start_of<Scalar, N>(kColumns);
      constexpr int kRowsDone = kRows == kLast ? kDone : 0;
      Scalar* const lower = P.data() + N * kColumn + kRow;
      Square<Scalar> old;
      Square<Scalar> fresh;
      unrolled<kCount<Scalar>>([&](auto j) __attribute__((always_inline)) {
        old[j] = load(lower + N * j);
        fresh[j] = changed(kColumn + j, kRows, old[j]);
      });
      Square<Scalar> mirror = fresh;
      transpose<Scalar>(mirror);
      unrolled<kCount<Scalar>>([&](auto j) __attribute__((always_inline)) {
        if constexpr (kRows == kColumns) fresh[j] = first_of<Scalar>(j, mirror[j], fresh[j]);
        if constexpr (kRowsDone > 0) fresh[j] = first_of<Scalar>(kRowsDone, old[j], fresh[j]);
        if constexpr (kColumns < kLast || j >= kDone) store<Scalar>(lower + N * j, fresh[j]);
      });
      if constexpr (kRows > kColumns) {
        Scalar* const upper = P.data() + N * kRow + kColumn;
        unrolled<kCount<Scalar>>([&](auto j) __attribute__((always_inline)) {
          if constexpr (j >= kRowsDone) store<Scalar>(upper + N * j, mirror[j]);
        });
      }
    }
  });
}

}  // namespace leeway::lanes
