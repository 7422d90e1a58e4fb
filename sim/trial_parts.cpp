#include "trial_parts.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "leeway/filters/horizontal.hpp"
#include "leeway/sim/random.hpp"

namespace leeway::sim {
namespace {

constexpr double kDivergedSigmas = 10.0;

/// A start whose error is drawn from P: the estimate e with difference(truth, e) = x, x ~ N(0, P).
Estimate drawn_start(const Estimate& truth, const ErrorMatrix& P, Random random) {
  ErrorVector unit;
  for (int i = 0; i < kErrorStates; ++i) unit(i) = random.normal();
  const Eigen::LDLT<ErrorMatrix> ldlt(P);
  const ErrorVector x =
      ldlt.transpositionsP().transpose() *
      (ldlt.matrixL() * (ldlt.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal() * unit));
  Estimate estimate = truth;
  inject(estimate, -x);
  return estimate;
}

/// x^T P^-1 x in units of the sigmas, which differ by 1e9; NaN unless P is positive.
double normalized_square(const ErrorVector& x, const ErrorMatrix& P) {
  const ErrorVector per_sigma = P.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<ErrorMatrix> llt(per_sigma.asDiagonal() * P * per_sigma.asDiagonal());
  if (llt.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  return llt.matrixL().solve(per_sigma.cwiseProduct(x)).squaredNorm();
}

/// NED axes of the local level frame at a position.
Eigen::Matrix3d ned_axes_at(const Estimate& truth) {
  return ned_to_ecef(geodetic_from_ecef(truth.nav.r_e_m)).transpose();
}

void score_position_claim(TrialScore& score, const Eigen::Vector3d& error_n_m,
                          const Eigen::Matrix3d& P_n_m2) {
  const Eigen::Vector2d error_ne_m = error_n_m.head<2>();
  const Eigen::Matrix2d P_ne_m2 = P_n_m2.topLeftCorner<2, 2>();
  score.variance_n_m2 += P_n_m2.diagonal();
  if (error_ne_m.norm() > horizontal_radius_m(P_ne_m2, 0.95)) ++score.beyond_r95;
  const double distance_sq = error_ne_m.dot(P_ne_m2.inverse() * error_ne_m);
  if (distance_sq > kDivergedSigmas * kDivergedSigmas) score.diverged = true;
}

}  // namespace

TrialStart trial_start(const TrialPlan& plan, std::uint64_t seed) {
  const ImuErrorModel& believed = plan.scene().filter.imu;
  Estimate start;
  start.nav = truth_at(plan.scene().trajectory, 0.0).nav;
  start.bias = {believed.accelerometer.bias, believed.gyro.bias};
  const ErrorMatrix P = initial_covariance(start, plan.initial(), believed);
  // What the sensors draw beyond the known biases is already the error of the start.
  ErrorMatrix P_nav = P;
  P_nav.bottomRightCorner<6, 6>().setZero();
  return {drawn_start(start, P_nav, Random(seed, 0, kInitialStateStream)), P};
}

Eigen::Vector3d position_error_n_m(const Estimate& truth, const Estimate& estimate) {
  return ned_axes_at(truth) * (truth.nav.r_e_m - estimate.nav.r_e_m);
}

void score_epoch(TrialScore& score, const Estimate& truth, const Estimate& estimate,
                 const ErrorMatrix* P) {
  const ErrorVector x = difference(truth, estimate);
  const double nees = P != nullptr ? normalized_square(x, *P) : 0.0;
  if (!std::isfinite(nees) || !x.allFinite()) {
    score.finite = false;
    return;
  }
  const Eigen::Matrix3d C_ne = ned_axes_at(truth);
  const Eigen::Vector3d error_n_m = C_ne * x.segment<3>(kDr);
  ++score.epochs;
  score.error_sq_n_m2 += error_n_m.cwiseAbs2();
  score.largest_horizontal_m = std::max(score.largest_horizontal_m, error_n_m.head<2>().norm());
  if (P == nullptr) return;
  score.nees += nees;
  score_position_claim(score, error_n_m, C_ne * P->block<3, 3>(kDr, kDr) * C_ne.transpose());
}

}  // namespace leeway::sim
