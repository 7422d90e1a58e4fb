/// The scenes of mechanizations against closed forms, which their verdicts are not.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/sim/atlas/atlas.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

using test::near;

/// Savage (1998): the share of a vibration that a scheme leaves out.
double share_left_out(const std::string& scheme, double x) {
  const double sinc = std::sin(x) / x;
  const double one_sample = 1.0 - sinc;
  if (scheme == "one-sample") return one_sample;
  return one_sample - 2.0 / 3.0 * std::pow(std::sin(0.5 * x), 2) * sinc;
}

/// Figures of a scene over what the closed form makes of the whole vibration at a frequency.
template <class Whole>
void check_shares(const char* key, Whole&& whole) {
  for (const AtlasCell& cell : atlas_scenes({key}).front().run({.brief = true})) {
    if (cell.variant != "one-sample" && cell.variant != "two-sample") continue;
    double frequency_hz = 0.0;
    double rate_hz = 0.0;
    REQUIRE(std::sscanf(cell.condition.c_str(), "%lf Hz at %lf Hz", &frequency_hz, &rate_hz) == 2);
    CAPTURE(cell.variant);
    CAPTURE(cell.condition);
    const double x = 2.0 * std::numbers::pi * frequency_hz / rate_hz;
    const double expected = whole(frequency_hz) * share_left_out(cell.variant, x);
    // To second order in the angle, and once at the start two-sample has no past: 2 %.
    CHECK(near(cell.figure / expected, 1.0, 0.02));
  }
}

}  // namespace

TEST_CASE("atlas: coning drifts as Savage's closed form, aliases included") {
  constexpr double kHalfAngleRad = 0.1 * kRadPerDeg;
  check_shares("coning", [](double frequency_hz) {
    const double radps = kHalfAngleRad * kHalfAngleRad * std::numbers::pi * frequency_hz;
    return radps / kRadPerDeg * 3600.0;
  });
}

TEST_CASE("atlas: sculling errs as Savage's closed form, aliases included") {
  constexpr double kRollRad = 0.2 * kRadPerDeg;
  constexpr double kSidewaysMps2 = 20.0;
  check_shares("sculling",
               [](double) { return 0.5 * kRollRad * kSidewaysMps2 / kStandardGravityMps2 * 1e3; });
}

}  // namespace leeway::sim
