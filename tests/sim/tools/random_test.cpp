#include "leeway/sim/tools/random.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

using test::near;

constexpr int kCount = 1'000'000;
constexpr std::uint64_t kSeed = 1;

std::vector<double> normals(Random random, int count) {
  std::vector<double> x(static_cast<std::size_t>(count));
  std::generate(x.begin(), x.end(), [&] { return random.normal(); });
  return x;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum / static_cast<double>(a.size());
}

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// Kolmogorov-Smirnov distance of a sample from a distribution, in units of 1 / sqrt(n).
template <class Distribution>
double kolmogorov_smirnov(std::vector<double> x, Distribution distribution) {
  std::sort(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  double worst = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double expected = distribution(x[i]);
    const auto rank = static_cast<double>(i);
    worst = std::max({worst, expected - rank / n, (rank + 1.0) / n - expected});
  }
  return worst * std::sqrt(n);
}

// P(D sqrt(n) > 1.95) = 0.001, P(D sqrt(n) < 0.31) = 6e-5.
constexpr double kMaxKs = 1.95;
constexpr double kMinKs = 0.31;

}  // namespace

TEST_CASE("Philox4x32-10 gives the known answers of its authors") {
  using Block = std::array<std::uint32_t, 4>;
  CHECK(philox4x32_10({0, 0, 0, 0}, {0, 0}) ==
        Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8});
  constexpr std::uint32_t kOnes = 0xffffffff;
  CHECK(philox4x32_10({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}) ==
        Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd});
  CHECK(philox4x32_10({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}) ==
        Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1});
}

TEST_CASE("the first numbers of seed 0 are the known answer as fractions") {
  Random random(0);
  // 52 of 64 bits: within 2^-52 of the block's words.
  CHECK(near(random.uniform(), (0x6627e8d5 + 0xe169c58d * 0x1p-32) * 0x1p-32, 0x1p-52));
  CHECK(near(random.uniform(), (0xbc57ac4c + 0x9b00dbd8 * 0x1p-32) * 0x1p-32, 0x1p-52));
}

TEST_CASE("the same seed, trial and stream give the same numbers, whatever was drawn elsewhere") {
  Random a(7, 3, 2);
  Random b(7, 3, 2);
  Random other(7, 4, 2);
  for (int i = 0; i < 1000; ++i) {
    other.normal3();
    CHECK(a.normal() == b.normal());
  }
}

TEST_CASE("normal3 is three normals in order, and a copy continues on its own") {
  Random a(1);
  Random b(1);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d v = a.normal3();
    CHECK(v.x() == b.normal());
    CHECK(v.y() == b.normal());
    CHECK(v.z() == b.normal());
  }
  Random copy = a;
  CHECK(copy.normal() == a.normal());
  CHECK(copy.uniform() == a.uniform());
}

TEST_CASE("a pair of normals is Box-Muller of a pair of uniforms, by the mathematical library") {
  Random normals(kSeed);
  Random uniforms(kSeed);
  for (int i = 0; i < 100'000; ++i) {
    const double radius = std::sqrt(-2.0 * std::log(uniforms.uniform()));
    const double angle = 2.0 * std::numbers::pi * uniforms.uniform();
    // The angle, up to 2 pi, rounds by 4.4e-16; the functions by less.
    REQUIRE(near(normals.normal(), radius * std::cos(angle), 1.5e-15 * radius));
    REQUIRE(near(normals.normal(), radius * std::sin(angle), 1.5e-15 * radius));
  }
}

TEST_CASE("uniform numbers are uniform and stay inside the open interval") {
  Random random(kSeed);
  std::vector<double> x(kCount);
  std::generate(x.begin(), x.end(), [&] { return random.uniform(); });
  CHECK(*std::min_element(x.begin(), x.end()) > 0.0);
  CHECK(*std::max_element(x.begin(), x.end()) < 1.0);
  const double ks = kolmogorov_smirnov(x, [](double u) { return u; });
  CHECK(ks < kMaxKs);
  CHECK(ks > kMinKs);
}

TEST_CASE("normal numbers have the moments of a normal distribution") {
  const std::vector<double> x = normals(Random(kSeed), kCount);
  double m1 = 0.0, m2 = 0.0, m3 = 0.0, m4 = 0.0;
  for (const double v : x) {
    m1 += v / kCount;
    m2 += v * v / kCount;
    m3 += v * v * v / kCount;
    m4 += v * v * v * v / kCount;
  }
  // Four standard deviations of each sample moment: variances 1, 2, 15, 96 over n.
  const double four_sigma = 4.0 / std::sqrt(kCount);
  CHECK(near(m1, 0.0, four_sigma));
  CHECK(near(m2, 1.0, four_sigma * std::sqrt(2.0)));
  CHECK(near(m3, 0.0, four_sigma * std::sqrt(15.0)));
  CHECK(near(m4, 3.0, four_sigma * std::sqrt(96.0)));
}

TEST_CASE("normal numbers follow the distribution into the tails") {
  const std::vector<double> x = normals(Random(kSeed), kCount);
  const double ks = kolmogorov_smirnov(x, normal_distribution);
  CHECK(ks < kMaxKs);
  CHECK(ks > kMinKs);
  for (const double limit : {2.0, 3.0, 4.0}) {
    CAPTURE(limit);
    const double p = 2.0 * normal_distribution(-limit);
    const auto beyond = static_cast<double>(
        std::count_if(x.begin(), x.end(), [&](double v) { return std::abs(v) > limit; }));
    // Binomial count, four standard deviations.
    CHECK(near(beyond, p * kCount, 4.0 * std::sqrt(p * kCount)));
  }
}

TEST_CASE("neighbouring seeds, trials, streams and draws are uncorrelated") {
  const std::vector<double> x = normals(Random(kSeed), kCount);
  const double four_sigma = 4.0 / std::sqrt(kCount);
  CHECK(near(correlation(x, normals(Random(kSeed + 1), kCount)), 0.0, four_sigma));
  CHECK(near(correlation(x, normals(Random(kSeed, 1), kCount)), 0.0, four_sigma));
  CHECK(near(correlation(x, normals(Random(kSeed, 0, 1), kCount)), 0.0, four_sigma));
  std::vector<double> shifted = x;
  std::rotate(shifted.begin(), shifted.begin() + 1, shifted.end());
  CHECK(near(correlation(x, shifted), 0.0, four_sigma));
}

TEST_CASE("all 64 bits of the seed count") {
  CHECK(Random(1).uniform() != Random(1 + (std::uint64_t{1} << 32)).uniform());
}

}  // namespace leeway::sim
