#include "sim/trials/trial_score.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "leeway/earth/earth.hpp"
#include "leeway/model/horizontal.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/tools/random.hpp"

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

/// P in units of its sigmas, which differ by 1e9. A bias of zero variance is no state of the
/// filter: it has no sigma, and 1 on the diagonal.
struct ScaledCovariance {
  ErrorVector per_sigma;
  Eigen::LLT<ErrorMatrix> llt;
  double to_all_states;  // from the number of states there are to 15

  explicit ScaledCovariance(const ErrorMatrix& P) {
    ErrorMatrix correlation = P;
    int states = 0;
    for (int i = 0; i < kErrorStates; ++i) {
      const bool is_state = i < kBa || P(i, i) != 0.0;
      states += is_state ? 1 : 0;
      per_sigma(i) = is_state ? 1.0 / std::sqrt(P(i, i)) : 0.0;
    }
    correlation = per_sigma.asDiagonal() * correlation * per_sigma.asDiagonal();
    for (int i = 0; i < kErrorStates; ++i) {
      if (per_sigma(i) == 0.0) correlation(i, i) = 1.0;
    }
    llt.compute(correlation);
    to_all_states = static_cast<double>(kErrorStates) / states;
  }

  bool is_positive() const { return llt.info() == Eigen::Success; }
};

/// x^T P^-1 x; NaN unless P is positive. Of a filter with fewer states taken to 15 by their number.
double normalized_square(const ErrorVector& x, const ErrorMatrix& P) {
  const ScaledCovariance scaled(P);
  if (!scaled.is_positive()) return std::numeric_limits<double>::quiet_NaN();
  return scaled.to_all_states *
         scaled.llt.matrixL().solve(scaled.per_sigma.cwiseProduct(x)).squaredNorm();
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

double expected_nees(const ErrorMatrix& second_moment, const ErrorMatrix& P) {
  const ScaledCovariance scaled(P);
  if (!scaled.is_positive()) return std::numeric_limits<double>::quiet_NaN();
  const ErrorMatrix moment =
      scaled.per_sigma.asDiagonal() * second_moment * scaled.per_sigma.asDiagonal();
  return scaled.to_all_states * scaled.llt.solve(moment).trace();
}

TrialStart trial_start(const TrialPlan& plan, std::uint64_t seed) {
  const ImuErrorModel& believed = plan.scene().filter.imu;
  Estimate start;
  start.nav = truth_at(plan.scene().trajectory, 0.0).nav;
  start.bias = {believed.accelerometer.bias, believed.gyro.bias};
  const ErrorMatrix P =
      initial_covariance(start, plan.initial(), believed, plan.scene().filter.biases);
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
