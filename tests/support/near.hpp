/// @file
/// Comparison with a tolerance in the unit of the values. doctest::Approx scales its tolerance with
/// the value, which lets 76 m pass in ECEF: it is not used on dimensional values.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace leeway::test {

inline bool near(double a, double b, double tolerance) { return std::abs(a - b) <= tolerance; }

/// Largest component of the difference.
template <class A, class B>
double distance(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

template <class A, class B>
bool near(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b, double tolerance) {
  return distance(a, b) <= tolerance;
}

/// Whether a mean of squares over its expectation is within four standard deviations of 1, by the
/// chi-square distribution.
inline bool is_chi_square_mean(double ratio, int degrees) {
  return near(ratio, 1.0, 4.0 * std::sqrt(2.0 / degrees));
}

}  // namespace leeway::test
