#include "leeway/model/error_metric.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "leeway/earth/earth.hpp"
#include "leeway/model/horizontal.hpp"

namespace leeway {
namespace {

/// 1 sigma along a horizontal direction, at an angle clockwise from north.
double sigma_along_m(const Eigen::Matrix3d& P_n_m2, double angle_rad) {
  const Eigen::Vector2d u(std::cos(angle_rad), std::sin(angle_rad));
  return std::sqrt(std::max(u.dot(P_n_m2.topLeftCorner<2, 2>() * u), 0.0));
}

}  // namespace

double size_of_error_m(ErrorMetric metric, const Eigen::Vector3d& error_n_m, double course_rad) {
  const double north = std::cos(course_rad);
  const double east = std::sin(course_rad);
  switch (metric) {
    case ErrorMetric::kAlong95:
      return std::abs(north * error_n_m.x() + east * error_n_m.y());
    case ErrorMetric::kCross95:
      return std::abs(north * error_n_m.y() - east * error_n_m.x());
    case ErrorMetric::kVertical95:
      return std::abs(error_n_m.z());
    default:
      return error_n_m.head<2>().norm();
  }
}

Eigen::Matrix3d ned_covariance(const Eigen::Vector3d& r_e_m, const Eigen::Matrix3d& P_rr_e_m2) {
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(r_e_m));
  return C_en.transpose() * P_rr_e_m2 * C_en;
}

double course_over_ground_rad(const NavState& nav) {
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(nav.r_e_m)).transpose();
  Eigen::Vector3d along_n = C_ne * nav.v_e_mps;
  if (along_n.head<2>().norm() < kStandingMps) {
    along_n = C_ne * (nav.q_eb * Eigen::Vector3d::UnitX());
  }
  return std::atan2(along_n.y(), along_n.x());
}

double error_size_m(ErrorMetric metric, const Eigen::Matrix3d& P_n_m2, double course_rad) {
  constexpr double kQuarterTurnRad = 0.5 * std::numbers::pi;
  switch (metric) {
    case ErrorMetric::kDrms:
      return std::sqrt(P_n_m2.topLeftCorner<2, 2>().trace());
    case ErrorMetric::kR50:
    case ErrorMetric::kR68:
    case ErrorMetric::kR95:
    case ErrorMetric::kR99:
      return horizontal_radius_m(P_n_m2.topLeftCorner<2, 2>(), radius_probability(metric));
    case ErrorMetric::kCross95:
      return kSigmasOf95 * sigma_along_m(P_n_m2, course_rad + kQuarterTurnRad);
    case ErrorMetric::kAlong95:
      return kSigmasOf95 * sigma_along_m(P_n_m2, course_rad);
    case ErrorMetric::kVertical95:
      return kSigmasOf95 * std::sqrt(P_n_m2(2, 2));
    case ErrorMetric::kAxis:
      return std::sqrt(principal_variances(P_n_m2.topLeftCorner<2, 2>()).x());
    case ErrorMetric::k3d:
      break;
  }
  return std::sqrt(P_n_m2.trace());
}

}  // namespace leeway
