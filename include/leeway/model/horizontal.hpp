/// @file
/// One number for the size of a horizontal position error: what a limit is stated in.
#pragma once

#include <Eigen/Core>

#include "leeway/earth/names.hpp"
#include "leeway/model/error_state.hpp"

namespace leeway {

/// Measures of a horizontal position error.
enum class HorizontalMetric {
  kDrms,  ///< sqrt(P_NN + P_EE): the root mean squared radial error
  kR95,   ///< the radius that 95 % of the errors stay within; 1.73 DRMS when N and E are alike
  kAxis,  ///< 1 sigma of the worse of north and east
};
constexpr auto names(HorizontalMetric) { return std::array{"drms", "r95", "axis"}; }

/// North-east covariance (m^2) of the position error at r_e_m.
/// @param P_rr_e_m2  covariance of dr_e in ECEF axes
Eigen::Matrix2d horizontal_covariance(const Eigen::Vector3d& r_e_m,
                                      const Eigen::Matrix3d& P_rr_e_m2);

/// The metric of a zero-mean Gaussian error with this covariance, in m.
/// @pre P is positive semidefinite.
double horizontal_error_m(HorizontalMetric metric, const Eigen::Matrix2d& P_ne_m2);

/// The radius within which a zero-mean Gaussian error stays with the given probability, in m.
/// Relative error below 1e-9. No heap. @pre P is positive semidefinite, 0 < probability < 1.
/// Source: the density in elliptic polar coordinates, integrated over the radius in closed form.
double horizontal_radius_m(const Eigen::Matrix2d& P_ne_m2, double probability);

/// The probability of an error beyond the radius: the inverse of horizontal_radius_m, an order of
/// magnitude cheaper. No heap. @pre P is positive semidefinite, radius_m >= 0.
double probability_beyond(const Eigen::Matrix2d& P_ne_m2, double radius_m);

}  // namespace leeway
