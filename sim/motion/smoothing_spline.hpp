/// @file
/// A smooth curve through noisy samples of several channels: a uniform B-spline of degree five,
/// fitted by least squares.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "leeway/sim/motion/jet.hpp"

namespace leeway::sim {

/// Four times continuously differentiable. The distance of the knots is the bandwidth: a sine of
/// up to 0.25 / knot_s Hz passes within 1 %, of one above 1 / knot_s Hz less than 5 % is left.
/// Where samples are missing the curve is the one of the least third differences.
class SmoothingSpline {
 public:
  using Samples = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// @param t_s      from 0, ascending
  /// @param samples  a row for each time, a column for each channel
  /// @pre two samples or more, knot_s > 0.
  SmoothingSpline(const std::vector<double>& t_s, const Samples& samples, double knot_s);

  /// A channel at a time, with its derivatives. @pre 0 <= t_s <= the last sample's time.
  Jet at(double t_s, Eigen::Index channel) const;

  /// Of the last knot before the end.
  std::vector<double> knots_s() const;

 private:
  double knot_s_;
  double end_s_;
  Samples coefficients_;
};

}  // namespace leeway::sim
