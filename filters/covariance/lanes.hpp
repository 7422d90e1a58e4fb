/// @file
/// A few numbers that the processor adds and multiplies at once, by the vector extension of g++ and
/// clang. A column of N numbers is walked in blocks of lanes; the last block is moved back to end
/// with the column, so it overlaps the one before it and nothing beyond the column is touched.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace leeway::lanes {

/// One lane, unless specialized: long double has no vectors.
template <class Scalar>
struct Vector {
  using Type = Scalar;
  static constexpr int kCount = 1;
};

template <>
struct Vector<float> {
  using Type __attribute__((vector_size(16))) = float;
  static constexpr int kCount = 4;
};

template <>
struct Vector<double> {
#if defined(__AVX__)
  using Type __attribute__((vector_size(32))) = double;
  static constexpr int kCount = 4;
#else
  using Type __attribute__((vector_size(16))) = double;
  static constexpr int kCount = 2;
#endif
};

template <class Scalar>
using VectorOf = typename Vector<Scalar>::Type;

template <class Scalar>
inline constexpr int kCount = Vector<Scalar>::kCount;

template <class Scalar, int N>
inline constexpr int kBlocks = (N + kCount<Scalar> - 1) / kCount<Scalar>;

/// First row of a block.
template <class Scalar, int N>
constexpr int start_of(int block) {
  const int start = block * kCount<Scalar>;
  return start < N - kCount<Scalar> ? start : N - kCount<Scalar>;
}

template <class Scalar>
[[gnu::always_inline]] inline VectorOf<Scalar> load(const Scalar* from) {
  using Loose __attribute__((aligned(alignof(Scalar)), may_alias)) = VectorOf<Scalar>;
  return *reinterpret_cast<const Loose*>(from);
}

template <class Scalar>
[[gnu::always_inline]] inline void store(Scalar* to, VectorOf<Scalar> v) {
  using Loose __attribute__((aligned(alignof(Scalar)), may_alias)) = VectorOf<Scalar>;
  *reinterpret_cast<Loose*>(to) = v;
}

/// 0, 1, 2, ...
template <class Scalar>
[[gnu::always_inline]] inline VectorOf<Scalar> count_up() {
  if constexpr (kCount<Scalar> == 4) {
    return VectorOf<Scalar>{0, 1, 2, 3};
  } else if constexpr (kCount<Scalar> == 2) {
    return VectorOf<Scalar>{0, 1};
  } else {
    return 0;
  }
}

/// The first `n` lanes of a, the others of b.
template <class Scalar>
[[gnu::always_inline]] inline VectorOf<Scalar> first_of(int n, const VectorOf<Scalar>& a,
                                                        const VectorOf<Scalar>& b) {
  return count_up<Scalar>() < static_cast<Scalar>(n) ? a : b;
}

/// Lane n of v, and zeros.
template <class Scalar>
[[gnu::always_inline]] inline VectorOf<Scalar> only(int n, const VectorOf<Scalar>& v) {
  return count_up<Scalar>() == static_cast<Scalar>(n) ? v : VectorOf<Scalar>{};
}

/// The sum of the lanes.
template <class Scalar>
[[gnu::always_inline]] inline Scalar total(const VectorOf<Scalar>& v) {
  if constexpr (kCount<Scalar> == 4) {
    return (v[0] + v[1]) + (v[2] + v[3]);
  } else if constexpr (kCount<Scalar> == 2) {
    return v[0] + v[1];
  } else {
    return v;
  }
}

/// std::array with the index that matrices have.
template <class T, int N>
struct Array {
  std::array<T, static_cast<std::size_t>(N)> values;
  T& operator[](int i) { return values[static_cast<std::size_t>(i)]; }
  const T& operator[](int i) const { return values[static_cast<std::size_t>(i)]; }
};

/// As many vectors as there are lanes, as a square matrix.
template <class Scalar>
using Square = Array<VectorOf<Scalar>, kCount<Scalar>>;

template <class Scalar>
[[gnu::always_inline]] inline void transpose(Square<Scalar>& m) {
  if constexpr (kCount<Scalar> == 4) {
    const auto even01 = __builtin_shufflevector(m[0], m[1], 0, 4, 2, 6);
    const auto odd01 = __builtin_shufflevector(m[0], m[1], 1, 5, 3, 7);
    const auto even23 = __builtin_shufflevector(m[2], m[3], 0, 4, 2, 6);
    const auto odd23 = __builtin_shufflevector(m[2], m[3], 1, 5, 3, 7);
    m[0] = __builtin_shufflevector(even01, even23, 0, 1, 4, 5);
    m[1] = __builtin_shufflevector(odd01, odd23, 0, 1, 4, 5);
    m[2] = __builtin_shufflevector(even01, even23, 2, 3, 6, 7);
    m[3] = __builtin_shufflevector(odd01, odd23, 2, 3, 6, 7);
  } else if constexpr (kCount<Scalar> == 2) {
    const auto first = __builtin_shufflevector(m[0], m[1], 0, 2);
    m[1] = __builtin_shufflevector(m[0], m[1], 1, 3);
    m[0] = first;
  }
}

/// f(integral_constant<int, 0>), f(1), ... f(N - 1): a loop that is unrolled whatever the compiler
/// thinks of it, with an index it knows.
template <int N, class F>
[[gnu::always_inline]] inline void unrolled(F&& f) {
  [&]<int... i>(std::integer_sequence<int, i...>) __attribute__((always_inline)) {
    (f(std::integral_constant<int, i>{}), ...);
  }
  (std::make_integer_sequence<int, N>{});
}

/// A column of N numbers, in blocks.
template <class Scalar, int N>
using Blocks = Array<VectorOf<Scalar>, kBlocks<Scalar, N>>;

/// f(block, first row of the block) for each block of a column of N.
template <class Scalar, int N, class F>
[[gnu::always_inline]] inline void each_block(F&& f) {
  unrolled<kBlocks<Scalar, N>>([&](auto b) __attribute__((always_inline)) {
    f(int{b}, start_of<Scalar, N>(b));
  });
}

}  // namespace leeway::lanes
