/// @file
/// The ellipse of a horizontal position error: how far from its middle errors come how often.
#pragma once

#include <Eigen/Core>

namespace leeway {

/// North-east covariance (m^2) of the position error at r_e_m.
/// @param P_rr_e_m2  covariance of dr_e in ECEF axes
Eigen::Matrix2d horizontal_covariance(const Eigen::Vector3d& r_e_m,
                                      const Eigen::Matrix3d& P_rr_e_m2);

/// Variances along the principal axes, the larger first, none below 0.
Eigen::Vector2d principal_variances(const Eigen::Matrix2d& P);

/// The radius within which a zero-mean Gaussian error stays with the given probability, in m.
/// Relative error below 1e-9. No heap. @pre P is positive semidefinite, 0 < probability < 1.
/// Source: the density in elliptic polar coordinates, integrated over the radius in closed form.
double horizontal_radius_m(const Eigen::Matrix2d& P_ne_m2, double probability);

/// The probability of an error beyond the radius: the inverse of horizontal_radius_m, an order of
/// magnitude cheaper. No heap. @pre P is positive semidefinite, radius_m >= 0.
double probability_beyond(const Eigen::Matrix2d& P_ne_m2, double radius_m);

}  // namespace leeway
