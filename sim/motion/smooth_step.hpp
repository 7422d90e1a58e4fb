/// @file
/// The step from 0 to 1 with two vanishing derivatives at both ends: what turns, ramps of speed and
/// changes of height are made of.
#pragma once

namespace leeway::sim {

/// 10 x^3 - 15 x^4 + 6 x^5, for x in 0 to 1.
template <class T>
T smooth_step(const T& x) {
  return x * x * x * (10.0 + x * (x * 6.0 - 15.0));
}

/// Its derivative; 1.875 in the middle.
template <class T>
T smooth_step_slope(const T& x) {
  return 30.0 * x * x * (1.0 - x) * (1.0 - x);
}
inline constexpr double kSmoothStepMaxSlope = 1.875;

/// Its integral from 0; 1/2 at the end.
template <class T>
T smooth_step_integral(const T& x) {
  return x * x * x * x * (2.5 + x * (x - 3.0));
}

}  // namespace leeway::sim
