#include "leeway/sim/tools/exact_sum.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "leeway/sim/tools/random.hpp"
#include "tests/support/numbers.hpp"

namespace leeway::sim {
namespace {

constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();
using test::kInf;
using test::kNan;

ExactSum exact(const std::vector<double>& terms) {
  ExactSum sum;
  for (const double t : terms) sum.add(t);
  return sum;
}

/// Of either sign, from the smallest subnormal to near the largest number.
std::vector<double> wild_numbers(std::uint64_t seed, std::size_t count) {
  Random random(seed);
  std::vector<double> x(count);
  for (double& v : x) {
    const double exponent = std::floor(-1074.0 + 2090.0 * random.uniform());
    v = std::ldexp(random.uniform() - 0.5, static_cast<int>(exponent));
  }
  return x;
}

}  // namespace

TEST_CASE("exact sums known in closed form") {
  const struct {
    std::vector<double> terms;
    double sum;
  } cases[] = {
      {{}, 0.0},
      {{-0.0}, 0.0},
      {{1.0}, 1.0},
      {{-1.0}, -1.0},
      {{0.1, 0.2, -0.3}, 0x1p-55},  // the doubles, not the decimals
      {{1e308, 1.0, -1e308}, 1.0},
      {{1.0, 1e100, 1.0, -1e100}, 2.0},
      {{1e16, 1.0, 1.0}, 10000000000000002.0},
      {{kTiny}, kTiny},
      {{-kTiny, -kTiny}, -2.0 * kTiny},
      {{kMax, kTiny, -kMax}, kTiny},
      {{0x1p-1022, -kTiny}, 0x1p-1022 - kTiny},  // the largest subnormal
      {{kMax, kMax, -kMax}, kMax},               // beyond the range on the way
      {{kMax, kMax}, kInf},
      {{-kMax, -kMax}, -kInf},
      // Half a unit in the last place: to even, and off the tie by the least there is.
      {{1.0, 0x1p-53}, 1.0},
      {{1.0 + 0x1p-52, 0x1p-53}, 1.0 + 0x1p-51},
      {{1.0, 0x1p-53, kTiny}, 1.0 + 0x1p-52},
      {{1.0 + 0x1p-52, 0x1p-53, -kTiny}, 1.0 + 0x1p-52},
      {{-1.0, -0x1p-53, -kTiny}, -1.0 - 0x1p-52},
  };
  for (const auto& c : cases) {
    CAPTURE(c.sum);
    CHECK(exact(c.terms).value() == c.sum);
  }
}

TEST_CASE("integers far beyond 53 bits on the way") {
  // 1 + 2 + .. + n, each a multiple of 2^60, and back down to n.
  constexpr int kCount = 100'000;
  ExactSum sum;
  for (int i = 1; i <= kCount; ++i) sum.add(std::ldexp(i, 60));
  CHECK(sum.value() == std::ldexp(0.5 * kCount * (kCount + 1.0), 60));
  for (int i = 1; i < kCount; ++i) sum.add(-std::ldexp(i, 60));
  CHECK(sum.value() == std::ldexp(kCount, 60));
}

TEST_CASE("against long double where that is exact: 64 bits, over seeds 1 to 20") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    ExactSum sum;
    long double reference = 0.0L;
    for (int i = 0; i < 1000; ++i) {
      // Multiples of 2^-52 below 1: a thousand of them need 62 bits.
      const double term = std::floor((2.0 * random.uniform() - 1.0) * 0x1p52) * 0x1p-52;
      sum.add(term);
      reference += term;
    }
    CHECK(sum.value() == static_cast<double>(reference));
  }
}

TEST_CASE("order and grouping leave no trace, over seeds 1 to 20") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    std::vector<double> terms = wild_numbers(seed, 500);
    const ExactSum forward = exact(terms);
    Random random(seed, 1);
    for (std::size_t i = terms.size() - 1; i > 0; --i) {
      std::swap(terms[i], terms[static_cast<std::size_t>(random.uniform() * double(i + 1))]);
    }
    CHECK(exact(terms) == forward);
    ExactSum parts;
    for (std::size_t from = 0; from < terms.size(); from += 37) {
      const auto begin = terms.begin() + static_cast<std::ptrdiff_t>(from);
      const auto end =
          terms.begin() + static_cast<std::ptrdiff_t>(std::min(from + 37, terms.size()));
      parts.add(exact({begin, end}));
    }
    CHECK(parts == forward);
    // Taking everything away leaves nothing, though the terms span 2000 bits.
    for (const double t : terms) parts.add(-t);
    CHECK(parts == ExactSum{});
    CHECK(parts.value() == 0.0);
  }
}

TEST_CASE("infinities and NaN act as with operator+, in any order and through merging") {
  const auto merged = [](const std::vector<double>& a, const std::vector<double>& b) {
    ExactSum sum = exact(a);
    sum.add(exact(b));
    return sum.value();
  };
  CHECK(exact({1.0, kInf, -kMax}).value() == kInf);
  CHECK(exact({-kInf, 1.0}).value() == -kInf);
  CHECK(std::isnan(exact({kInf, -kInf}).value()));
  CHECK(std::isnan(exact({kNan, 1.0}).value()));
  CHECK(std::isnan(exact({kNan, kInf}).value()));
  CHECK(merged({kInf}, {1.0}) == kInf);
  CHECK(merged({1.0}, {-kInf}) == -kInf);
  CHECK(std::isnan(merged({kInf}, {-kInf})));
  CHECK(std::isnan(merged({1.0}, {kNan})));
}

}  // namespace leeway::sim
