#include "leeway/sim/tools/exact_sum.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

namespace leeway::sim {
namespace {

constexpr int kMantissaBits = 53;
constexpr int kLowestExponent = -1074;  // of the unit of the last place of a subnormal
constexpr int kLimbBits = 64;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// limb <- limb + term + carry. @returns the new carry.
bool add_with_carry(std::uint64_t& limb, std::uint64_t term, bool carry) {
  limb += term;
  const bool first = limb < term;
  limb += carry ? 1 : 0;
  return first || (carry && limb == 0);
}

template <class Limbs>
void negate(Limbs& limbs) {
  bool carry = true;
  for (std::uint64_t& limb : limbs) {
    limb = ~limb;
    carry = add_with_carry(limb, 0, carry);
  }
}

/// Adds word * 2^(64 limb). A negative term is added as what complements it: subtracted.
template <class Limbs>
void add_word(Limbs& limbs, std::size_t limb, std::uint64_t word, bool negative) {
  if (!negative) {
    bool carry = add_with_carry(limbs[limb], word, false);
    while (carry && ++limb < limbs.size()) carry = add_with_carry(limbs[limb], 0, true);
    return;
  }
  bool borrow = limbs[limb] < word;
  limbs[limb] -= word;
  while (borrow && ++limb < limbs.size()) borrow = limbs[limb]-- == 0;
}

}  // namespace

void ExactSum::add(double term) {
  if (!std::isfinite(term)) {
    has_nan_ |= std::isnan(term);
    has_plus_infinity_ |= term == kInfinity;
    has_minus_infinity_ |= term == -kInfinity;
    return;
  }
  if (term == 0.0) return;
  // |term| = mantissa * 2^(shift + kLowestExponent), shift >= 0.
  const auto bits = std::bit_cast<std::uint64_t>(std::abs(term));
  const std::uint64_t exponent = bits >> (kMantissaBits - 1);
  const std::uint64_t hidden_bit = std::uint64_t{exponent > 0 ? 1u : 0u} << (kMantissaBits - 1);
  const std::uint64_t fraction_mask = (std::uint64_t{1} << (kMantissaBits - 1)) - 1;
  const std::uint64_t mantissa = (bits & fraction_mask) | hidden_bit;
  const std::uint64_t shift = exponent > 0 ? exponent - 1 : 0;
  const std::size_t limb = shift / kLimbBits;
  const std::uint64_t offset = shift % kLimbBits;
  add_word(limbs_, limb, mantissa << offset, term < 0.0);
  if (offset > 0) add_word(limbs_, limb + 1, mantissa >> (kLimbBits - offset), term < 0.0);
}

void ExactSum::add(const ExactSum& other) {
  bool carry = false;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    carry = add_with_carry(limbs_[i], other.limbs_[i], carry);
  }
  has_nan_ |= other.has_nan_;
  has_plus_infinity_ |= other.has_plus_infinity_;
  has_minus_infinity_ |= other.has_minus_infinity_;
}

double ExactSum::value() const {
  if (has_nan_ || (has_plus_infinity_ && has_minus_infinity_)) return kNan;
  if (has_plus_infinity_) return kInfinity;
  if (has_minus_infinity_) return -kInfinity;
  const bool negative = limbs_.back() >> (kLimbBits - 1) != 0;
  Limbs magnitude = limbs_;
  if (negative) negate(magnitude);
  return negative ? -rounded(magnitude) : rounded(magnitude);
}

double ExactSum::rounded(const Limbs& magnitude) {
  std::size_t top = kLimbs;
  while (top > 0 && magnitude[top - 1] == 0) --top;
  if (top == 0) return 0.0;
  // The 64 bits from the leading one down; what lies below matters as being zero or not.
  std::uint64_t leading = magnitude[--top];
  int exponent = kLowestExponent;
  if (top > 0) {
    const int empty_bits = std::countl_zero(leading);
    const std::uint64_t next = magnitude[top - 1];
    leading <<= empty_bits;
    if (empty_bits > 0) leading |= next >> (kLimbBits - empty_bits);
    std::uint64_t rest = next << empty_bits;
    for (std::size_t i = 0; i + 1 < top; ++i) rest |= magnitude[i];
    leading |= rest != 0 ? 1 : 0;
    exponent += static_cast<int>(top) * kLimbBits - empty_bits;
  }
  // 64 bits to 53 by the conversion, to nearest even; ldexp is exact. Below 2^-1010 nothing lies
  // beneath the lowest limb.
  return std::ldexp(static_cast<double>(leading), exponent);
}

}  // namespace leeway::sim
