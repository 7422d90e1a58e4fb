#include "leeway/monitors/nis_cusum.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace leeway {
namespace {

/// Measurements until the alarm, of innovations whose deviation is `scale` times as claimed.
int until_alarm(double scale, int dof, unsigned seed, int longest) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, scale);
  NisCusum cusum;
  for (int k = 1; k <= longest; ++k) {
    double nis = 0.0;
    for (int i = 0; i < dof; ++i) nis += std::pow(normal(random), 2);
    if (cusum.push(std::min(nis, 30.0), dof)) return k;
  }
  return longest;
}

TEST_CASE("a right claim is called wrong less than once in e^10 measurements") {
  for (const int dof : {1, 3}) {
    CAPTURE(dof);
    double sum = 0.0;
    constexpr int kSeeds = 20;
    for (unsigned seed = 1; seed <= kSeeds; ++seed) sum += until_alarm(1.0, dof, seed, 100'000);
    CHECK(sum / kSeeds > 22'000.0);  // Lorden's bound on the mean
  }
}

TEST_CASE("sigmas three times too small are told within a few measurements") {
  double sum = 0.0;
  constexpr int kSeeds = 200;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) sum += until_alarm(3.0, 3, seed, 1000);
  // Each adds 0.5 (0.75 * 27 - 3 ln 4) = 8.0 on average, less for the cap of 30, and 10 is asked.
  CHECK(sum / kSeeds > 1.5);
  CHECK(sum / kSeeds < 4.0);
}

}  // namespace
}  // namespace leeway
