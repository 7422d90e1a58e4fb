/// @file
/// Random states for the Jacobian tests, and derivatives by finite differences.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <cstdint>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/sim/tools/random.hpp"

namespace leeway::test {

/// At rest on the equator, body axes along ECEF: x is up.
inline Estimate at_equator() {
  Estimate e;
  e.nav.r_e_m = {wgs84::kSemiMajorAxisM, 0.0, 0.0};
  return e;
}

inline Eigen::Vector3d random_vector(sim::Random& random, double max_norm) {
  return max_norm * random.uniform() * random.normal3().normalized();
}

/// Any attitude, up to 300 m/s, anywhere from -100 m to 20 km high; every fourth seed is within
/// 100 m of a pole. Biases up to 1 m/s^2 and 0.02 rad/s.
inline Estimate random_estimate(std::uint64_t seed) {
  sim::Random random(seed);
  Geodetic place;
  place.lat_rad = std::asin(2.0 * random.uniform() - 1.0);
  if (seed % 4 == 0) {
    place.lat_rad = std::copysign(90.0 * kRadPerDeg - 1.5e-5 * random.uniform(), place.lat_rad);
  }
  place.lon_rad = (2.0 * random.uniform() - 1.0) * 180.0 * kRadPerDeg;
  place.height_m = -100.0 + 20'100.0 * random.uniform();
  Estimate estimate;
  estimate.nav.r_e_m = ecef_from_geodetic(place);
  estimate.nav.v_e_mps = random_vector(random, 300.0);
  estimate.nav.q_eb =
      Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
          .normalized();
  estimate.bias.b_a_mps2 = random_vector(random, 1.0);
  estimate.bias.b_g_radps = random_vector(random, 0.02);
  return estimate;
}

/// df/dx at x = 0 by the central five-point stencil, one step length per state: the error is
/// step^4 / 30 times the fifth derivative.
template <class F>
auto central_jacobian(const F& f, const ErrorVector& steps) {
  using Value = decltype(f(ErrorVector()));
  Eigen::Matrix<double, Value::RowsAtCompileTime, kErrorStates> J;
  for (int j = 0; j < kErrorStates; ++j) {
    const auto at = [&](double multiple) -> Value {
      return f(ErrorVector::Unit(j) * multiple * steps(j));
    };
    J.col(j) = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * steps(j));
  }
  return J;
}

/// The steps at which truncation and rounding are both below 1e-8 of a block, in the order of the
/// states: rad, m/s, m, m/s^2, rad/s.
inline ErrorVector jacobian_steps(double psi, double dv, double dr, double b_a, double b_g) {
  ErrorVector steps;
  steps << Eigen::Vector3d::Constant(psi), Eigen::Vector3d::Constant(dv),
      Eigen::Vector3d::Constant(dr), Eigen::Vector3d::Constant(b_a), Eigen::Vector3d::Constant(b_g);
  return steps;
}

/// Largest |A - B| element in units of sqrt(B_ii B_jj): covariances compared unit by unit.
template <class A, class B>
double scaled_distance(const A& a, const B& b) {
  const Eigen::VectorXd sigma = b.diagonal().cwiseSqrt();
  return ((a - b).array() / (sigma * sigma.transpose()).array()).abs().maxCoeff();
}

}  // namespace leeway::test
