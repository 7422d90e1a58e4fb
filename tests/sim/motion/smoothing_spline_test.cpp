#include "sim/motion/smoothing_spline.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "leeway/sim/tools/random.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

using test::near;

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// Samples of a function at 20 Hz over 60 s.
template <class Function>
SmoothingSpline spline_of(const Function& f, double knot_s) {
  std::vector<double> t_s;
  for (int k = 0; k <= 1200; ++k) t_s.push_back(0.05 * k);
  SmoothingSpline::Samples samples(1201, 1);
  for (int k = 0; k <= 1200; ++k) samples(k, 0) = f(t_s[static_cast<std::size_t>(k)]);
  return {t_s, samples, knot_s};
}

/// Largest relative error of what the spline makes of a sine, away from its ends.
double sine_error(double frequency_hz, double knot_s) {
  const SmoothingSpline spline =
      spline_of([=](double t) { return std::sin(kTwoPi * frequency_hz * t); }, knot_s);
  double error = 0.0;
  for (double t_s = 10.0; t_s < 50.0; t_s += 0.013) {
    error =
        std::max(error, std::abs(spline.at(t_s, 0).value - std::sin(kTwoPi * frequency_hz * t_s)));
  }
  return error;
}

double sine_amplitude(double frequency_hz, double knot_s) {
  const SmoothingSpline spline =
      spline_of([=](double t) { return std::sin(kTwoPi * frequency_hz * t); }, knot_s);
  double size = 0.0;
  for (double t_s = 10.0; t_s < 50.0; t_s += 0.013) {
    size = std::max(size, std::abs(spline.at(t_s, 0).value));
  }
  return size;
}

}  // namespace

TEST_CASE("smoothing spline: a parabola is itself, to its ends, derivatives too") {
  const SmoothingSpline spline =
      spline_of([](double t) { return 3.0 - 2.0 * t + 0.5 * t * t; }, 0.7);
  for (const double t_s : {0.0, 0.7, 31.4159, 59.9, 60.0}) {
    CAPTURE(t_s);
    const Jet x = spline.at(t_s, 0);
    // Rounding of 2000, times the condition of the equations.
    CHECK(near(x.value, 3.0 - 2.0 * t_s + 0.5 * t_s * t_s, 1e-9));
    CHECK(near(x.first, -2.0 + t_s, 1e-9));
    CHECK(near(x.second, 1.0, 1e-8));
  }
}

TEST_CASE("smoothing spline: the stated bandwidth") {
  for (const double knot_s : {0.5, 1.0, 2.0}) {
    CAPTURE(knot_s);
    CHECK(sine_error(0.1 / knot_s, knot_s) < 1e-3);
    CHECK(sine_error(0.25 / knot_s, knot_s) < 0.01);
    CHECK(sine_amplitude(1.03 / knot_s, knot_s) < 0.05);
    CHECK(sine_amplitude(1.9 / knot_s, knot_s) < 0.05);
  }
}

TEST_CASE("smoothing spline: its derivatives are derivatives, across knots too") {
  const SmoothingSpline spline = spline_of([](double t) { return std::sin(t) + 0.1 * t; }, 0.5);
  const double h_s = 1e-4;
  for (double t_s = 0.3; t_s < 59.0; t_s += 0.1) {
    const double first = (spline.at(t_s + h_s, 0).value - spline.at(t_s - h_s, 0).value) / 2e-4;
    const double second = (spline.at(t_s + h_s, 0).first - spline.at(t_s - h_s, 0).first) / 2e-4;
    CHECK(near(spline.at(t_s, 0).first, first, 1e-8));
    CHECK(near(spline.at(t_s, 0).second, second, 1e-8));
  }
}

TEST_CASE("smoothing spline: noise is averaged over a knot") {
  Random random(1);
  const SmoothingSpline spline = spline_of([&random](double) { return random.normal(); }, 1.0);
  double square = 0.0;
  int count = 0;
  for (double t_s = 5.0; t_s < 55.0; t_s += 0.1, ++count) {
    square += std::pow(spline.at(t_s, 0).value, 2);
  }
  // One coefficient from 20 samples: variance 1/20; 50 independent values, 4 standard deviations.
  CHECK(near(square / count, 0.05, 0.05 * 4.0 * std::sqrt(2.0 / 50.0)));
}

TEST_CASE("smoothing spline: a hole is bridged smoothly") {
  std::vector<double> t_s;
  for (double t = 0.0; t <= 60.0; t += 0.05) {
    if (t < 30.0 || t > 33.0) t_s.push_back(t);
  }
  SmoothingSpline::Samples samples(static_cast<Eigen::Index>(t_s.size()), 1);
  for (std::size_t k = 0; k < t_s.size(); ++k) {
    samples(static_cast<Eigen::Index>(k), 0) = std::sin(0.3 * t_s[k]);
  }
  const SmoothingSpline spline(t_s, samples, 0.5);
  for (double t = 29.0; t < 34.0; t += 0.1) {
    CAPTURE(t);
    // What a cubic from both sides leaves of the sine: (0.3)^4 times a few m.
    CHECK(near(spline.at(t, 0).value, std::sin(0.3 * t), 0.02));
    CHECK(near(spline.at(t, 0).second, -0.09 * std::sin(0.3 * t), 0.03));
  }
}

}  // namespace leeway::sim
