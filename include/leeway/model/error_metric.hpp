/// @file
/// One number for the size of a position error: what a limit is stated in.
#pragma once

#include <Eigen/Core>
#include <array>

#include "leeway/earth/names.hpp"
#include "leeway/strapdown/nav_state.hpp"

namespace leeway {

/// Measures of a position error that is Gaussian with zero mean. Those without another word are
/// horizontal. RNN is the radius of the circle that NN % of the errors stay within.
enum class ErrorMetric {
  kDrms,        ///< root mean squared radial error: sqrt(P_NN + P_EE)
  kR50,         ///< the median, called CEP
  kR68,         ///< of 68 %, not 68.27 %
  kR95,         ///< 1.73 DRMS when N and E are alike
  kR99,         ///< 2.15 DRMS when N and E are alike
  kCross95,     ///< across the track: 95 % are within plus and minus this, 1.96 sigma
  kAlong95,     ///< along the track, likewise
  kVertical95,  ///< of the height, likewise
  kAxis,        ///< 1 sigma along the largest principal axis
  k3d,          ///< root mean squared error in space: sqrt(P_NN + P_EE + P_DD)
};
constexpr auto names(ErrorMetric) {
  return std::array{"drms",    "r50",     "r68",        "r95",  "r99",
                    "cross95", "along95", "vertical95", "axis", "3d"};
}

/// Probability that an RNN is the radius of; 0 of the other metrics.
constexpr double radius_probability(ErrorMetric metric) {
  switch (metric) {
    case ErrorMetric::kR50:
      return 0.50;
    case ErrorMetric::kR68:
      return 0.68;
    case ErrorMetric::kR95:
      return 0.95;
    case ErrorMetric::kR99:
      return 0.99;
    default:
      return 0.0;
  }
}

/// Whether a metric depends on the course over ground.
constexpr bool asks_for_course(ErrorMetric metric) {
  return metric == ErrorMetric::kCross95 || metric == ErrorMetric::kAlong95;
}

/// Whether a metric depends on the error of the height.
constexpr bool asks_for_height(ErrorMetric metric) {
  return metric == ErrorMetric::kVertical95 || metric == ErrorMetric::k3d;
}

/// The probability that a metric is the quantile of; 0 of a root mean square or a sigma.
constexpr double quantile_probability(ErrorMetric metric) {
  const bool is_of_an_axis = asks_for_course(metric) || metric == ErrorMetric::kVertical95;
  return is_of_an_axis ? 0.95 : radius_probability(metric);
}

/// What such a metric is the quantile of: the size in m of one error north, east, down. Of the
/// other metrics the horizontal distance.
/// @param course_rad  over ground, clockwise from north
double size_of_error_m(ErrorMetric metric, const Eigen::Vector3d& error_n_m, double course_rad);

/// Half width, in sigmas, of the interval that holds 95 % of a Gaussian: the quantile of 0.975.
inline constexpr double kSigmasOf95 = 1.959963984540054;

/// Speed over ground in m/s below which a vehicle stands and has no course.
inline constexpr double kStandingMps = 0.1;

/// North-east-down covariance (m^2) of the position error at r_e_m.
/// @param P_rr_e_m2  covariance of dr_e in ECEF axes
Eigen::Matrix3d ned_covariance(const Eigen::Vector3d& r_e_m, const Eigen::Matrix3d& P_rr_e_m2);

/// Course over ground of a vehicle, clockwise from north, -pi to pi rad. Of one that stands, below
/// kStandingMps, it is the heading of the body's forward axis.
double course_over_ground_rad(const NavState& nav);

/// The size of an error with this covariance by a metric, in m. Relative error of RNN below 1e-9,
/// of the others rounding. No heap.
/// @param P_n_m2      of north, east and down
/// @param course_rad  over ground, clockwise from north; cross95 and along95 go by it
/// @pre P is positive semidefinite.
double error_size_m(ErrorMetric metric, const Eigen::Matrix3d& P_n_m2, double course_rad);

}  // namespace leeway
