#include "leeway/gnss_fix.hpp"

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

}  // namespace leeway
