#include "leeway/sensors/gnss_fix.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace leeway {
namespace {

constexpr double kMinRadiusM = wgs84::kSemiMinorAxisM - 1e5;
constexpr double kMaxRadiusM = wgs84::kSemiMajorAxisM + 1e5;
constexpr double kFastestMps = 1e4;
constexpr double kSymmetryTolerance = 1e-9;  // relative; rotation into ECEF leaves 1e-16

bool is_covariance(const Eigen::Matrix3d& R) {
  if (!R.allFinite()) return false;
  const double scale = R.diagonal().maxCoeff();
  if ((R - R.transpose()).cwiseAbs().maxCoeff() > kSymmetryTolerance * scale) return false;
  const Eigen::LLT<Eigen::Matrix3d> llt(R);
  return llt.info() == Eigen::Success && llt.matrixLLT().diagonal().minCoeff() >= kLeastSigma;
}

}  // namespace

GnssPosition GnssPosition::from_geodetic(const Geodetic& position, const Eigen::Matrix3d& R_n_m2) {
  const Eigen::Matrix3d C_en = ned_to_ecef(position);
  return {ecef_from_geodetic(position), C_en * R_n_m2 * C_en.transpose()};
}

GnssVelocity GnssVelocity::from_ned(const Geodetic& place, const Eigen::Vector3d& v_n_mps,
                                    const Eigen::Matrix3d& R_n_m2ps2) {
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  return {C_en * v_n_mps, C_en * R_n_m2ps2 * C_en.transpose()};
}

bool is_usable(const GnssFix& fix) {
  if (!fix.position && !fix.velocity) return false;
  if (fix.position) {
    const double radius_m = fix.position->r_e_m.norm();
    if (!(radius_m > kMinRadiusM && radius_m < kMaxRadiusM)) return false;
    if (!is_covariance(fix.position->R_e_m2)) return false;
  }
  if (fix.velocity) {
    if (!(fix.velocity->v_e_mps.norm() < kFastestMps)) return false;
    if (!is_covariance(fix.velocity->R_e_m2ps2)) return false;
  }
  return true;
}

bool agree(const GnssFix& earlier, const GnssFix& later) {
  constexpr double kLongestS = 5.0;
  constexpr double kChangeMps2 = 3.0;
  constexpr double kGate = 16.27;  // chi-square, 3 degrees of freedom, 99.9 %
  const double dt_s = to_seconds(later.time - earlier.time);
  if (!(dt_s > 0.0 && dt_s <= kLongestS) || !earlier.position || !later.position ||
      !earlier.velocity || !later.velocity) {
    return false;
  }
  const Eigen::Vector3d v_mean_e_mps = 0.5 * (earlier.velocity->v_e_mps + later.velocity->v_e_mps);
  const Eigen::Vector3d left_e_m =
      later.position->r_e_m - earlier.position->r_e_m - dt_s * v_mean_e_mps;
  // The trapezoid of a velocity whose slope changes by a errs by a dt^2 / 12.
  const double bend_m = kChangeMps2 * dt_s * dt_s / 12.0;
  const Eigen::Matrix3d R_e_m2 =
      earlier.position->R_e_m2 + later.position->R_e_m2 +
      0.25 * dt_s * dt_s * (earlier.velocity->R_e_m2ps2 + later.velocity->R_e_m2ps2) +
      bend_m * bend_m * Eigen::Matrix3d::Identity();
  return left_e_m.dot(R_e_m2.llt().solve(left_e_m)) <= kGate;
}

}  // namespace leeway
