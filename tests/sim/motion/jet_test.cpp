#include "leeway/sim/motion/jet.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

using test::near;

// A function and its first two derivatives written out by hand.
struct Known {
  double value, first, second;
};

void check(const Jet& jet, const Known& known) {
  // Values of order 1 to 30, a handful of roundings each.
  CHECK(near(jet.value, known.value, 1e-14));
  CHECK(near(jet.first, known.first, 1e-13));
  CHECK(near(jet.second, known.second, 1e-12));
}

constexpr double kTimes[] = {-1.3, -0.2, 0.4, 1.7};

}  // namespace

TEST_CASE("each operation agrees with derivatives written out by hand") {
  for (const double t : kTimes) {
    CAPTURE(t);
    const Jet x = time_jet(t);
    check(x * x * x - 2.0 * x + 1.0, {t * t * t - 2 * t + 1, 3 * t * t - 2, 6 * t});
    check(-x, {-t, -1.0, 0.0});
    check(1.0 / (2.0 + x), {1 / (2 + t), -1 / ((2 + t) * (2 + t)), 2 / std::pow(2 + t, 3)});
    check(sin(3.0 * x), {std::sin(3 * t), 3 * std::cos(3 * t), -9 * std::sin(3 * t)});
    check(cos(x * x), {std::cos(t * t), -2 * t * std::sin(t * t),
                       -2 * std::sin(t * t) - 4 * t * t * std::cos(t * t)});
    const double root = std::sqrt(2 + t);
    check(sqrt(2.0 + x), {root, 0.5 / root, -0.25 / (root * root * root)});
  }
}

TEST_CASE("the quotient of two functions obeys q b = a") {
  for (const double t : kTimes) {
    CAPTURE(t);
    const Jet a = sin(2.0 * time_jet(t)) + 3.0;
    const Jet b = cos(time_jet(t)) + 2.0;
    const Jet product = a / b * b;
    check(product, {a.value, a.first, a.second});
  }
}

TEST_CASE("atan2 returns the angle of a turning vector, and its rates, in all four quadrants") {
  for (const double t : kTimes) {
    CAPTURE(t);
    // Angle t + t^2 / 2 on a radius that changes too.
    const Jet angle = time_jet(t) + 0.5 * time_jet(t) * time_jet(t);
    const Jet radius = 2.0 + sin(time_jet(t));
    const Jet recovered = atan2(radius * sin(angle), radius * cos(angle));
    CHECK(near(std::remainder(recovered.value - angle.value, 2 * std::numbers::pi), 0.0, 1e-14));
    CHECK(near(recovered.first, 1 + t, 1e-13));
    CHECK(near(recovered.second, 1.0, 1e-12));
  }
}

TEST_CASE("atan2 of a point at rest in the origin is the constant zero") {
  const Jet angle = atan2(Jet(0.0), Jet(0.0));
  CHECK(angle.value == 0.0);
  CHECK(angle.first == 0.0);
  CHECK(angle.second == 0.0);
}

}  // namespace leeway::sim
