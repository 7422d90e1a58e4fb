/// @file
/// A motion in closed form and what an ideal sensor delivers on it: an independent answer for the
/// strapdown. Written apart from the simulators, which the core tests do not see.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "leeway/sensors/imu.hpp"
#include "leeway/strapdown/nav_state.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway::test {

/// offset + slope t + two sines of amplitude, angular frequency and phase.
struct Channel {
  struct Sine {
    double amplitude{};
    double omega_radps{};
    double phase_rad{};
  };
  double offset{};
  double slope{};
  std::array<Sine, 2> sines{};

  double value(double t) const;
  double rate(double t) const;
  double acceleration(double t) const;
};

/// Position in the tangent plane of an origin, Euler angles with respect to its axes.
struct AnalyticMotion {
  Geodetic origin{};
  std::array<Channel, 3> ned_m{};
  Channel roll{};
  Channel pitch{};
  Channel yaw{};
  EarthRotation rotation{EarthRotation::kOn};

  NavState state(double t) const;
  ImuSample sample(double t) const;
  /// Integrals of sample() over (from, to] by 8-point Gauss-Legendre.
  ImuIncrement increment(Time from, Time to) const;
};

/// 20 m/s, one wide turn, sway, bounce and nodding: everything that couples, nothing faster than
/// 12 rad/s.
AnalyticMotion rough_drive();

/// Largest position error over the intervals that end at the given times, the first time being the
/// start. Errors are read at every `every`-th end.
double position_error_m(const AnalyticMotion& motion, const std::vector<Time>& times,
                        StrapdownFunction step, std::size_t every);

}  // namespace leeway::test
