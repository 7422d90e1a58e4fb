/// @file
/// Exact sums of doubles: the same bits in any order of the terms, on any number of threads or
/// machines, in constant memory.
#pragma once

#include <array>
#include <cstdint>

namespace leeway::sim {

/// A fixed-point number as wide as the whole range of double. Every finite double is a multiple of
/// 2^-1074 and below 2^1024. There is room for 2^77 terms of any size.
/// Source: Kulisch and Miranker, The Arithmetic of the Digital Computer: A New Approach (1986).
class ExactSum {
 public:
  /// The sum with one term more, or with all terms of another sum.
  void add(double term);
  void add(const ExactSum& other);

  /// The sum, rounded once to nearest, ties to even; +-infinity where it overflows. As with
  /// operator+, an infinite term gives infinity; a NaN, or infinities of both signs, give NaN.
  double value() const;

  bool operator==(const ExactSum&) const = default;

 private:
  static constexpr std::size_t kLimbs = 34;
  using Limbs = std::array<std::uint64_t, kLimbs>;

  static double rounded(const Limbs& magnitude);

  Limbs limbs_{};  // two's complement in units of 2^-1074, lowest first
  bool has_nan_{false};
  bool has_plus_infinity_{false};
  bool has_minus_infinity_{false};
};

}  // namespace leeway::sim
