/// @file
/// Values with their first and second time derivatives. A motion is written once, as a closed form;
/// its velocity and acceleration are then exact to rounding.
#pragma once

#include <cmath>

namespace leeway::sim {

/// A function of time at one moment: its value and its first two derivatives, per second. Constants
/// convert implicitly.
struct Jet {
  constexpr Jet(double constant = 0.0) : value(constant) {}
  constexpr Jet(double v, double d1, double d2) : value(v), first(d1), second(d2) {}

  double value{};
  double first{};
  double second{};
};

/// The time t itself as a function of time: derivatives 1 and 0.
constexpr Jet time_jet(double t_s) { return {t_s, 1.0, 0.0}; }

constexpr Jet operator-(const Jet& a) { return {-a.value, -a.first, -a.second}; }

constexpr Jet operator+(const Jet& a, const Jet& b) {
  return {a.value + b.value, a.first + b.first, a.second + b.second};
}

constexpr Jet operator-(const Jet& a, const Jet& b) {
  return {a.value - b.value, a.first - b.first, a.second - b.second};
}

constexpr Jet operator*(const Jet& a, const Jet& b) {
  return {a.value * b.value, a.first * b.value + a.value * b.first,
          a.second * b.value + 2.0 * a.first * b.first + a.value * b.second};
}

/// @pre b.value != 0.
constexpr Jet operator/(const Jet& a, const Jet& b) {
  const double q = a.value / b.value;
  const double d1 = (a.first - q * b.first) / b.value;
  return {q, d1, (a.second - 2.0 * d1 * b.first - q * b.second) / b.value};
}

inline Jet sin(const Jet& a) {
  const double s = std::sin(a.value);
  const double c = std::cos(a.value);
  return {s, c * a.first, c * a.second - s * a.first * a.first};
}

inline Jet cos(const Jet& a) {
  const double s = std::sin(a.value);
  const double c = std::cos(a.value);
  return {c, -s * a.first, -s * a.second - c * a.first * a.first};
}

/// @pre a.value > 0.
inline Jet sqrt(const Jet& a) {
  const double root = std::sqrt(a.value);
  const double d1 = 0.5 * a.first / root;
  return {root, d1, (0.5 * a.second - d1 * d1) / root};
}

/// The angle of the point (x, y), in rad; at the origin its derivatives are zero.
/// @pre x and y are not both zero, unless both are constants.
inline Jet atan2(const Jet& y, const Jet& x) {
  const double angle = std::atan2(y.value, x.value);
  const double norm_sq = x.value * x.value + y.value * y.value;
  if (norm_sq == 0.0) return angle;
  const double d1 = (x.value * y.first - y.value * x.first) / norm_sq;
  const double norm_sq_rate = 2.0 * (x.value * x.first + y.value * y.first);
  return {angle, d1, (x.value * y.second - y.value * x.second - d1 * norm_sq_rate) / norm_sq};
}

}  // namespace leeway::sim
