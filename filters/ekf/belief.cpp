#include "leeway/ekf/belief.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "leeway/covariance/covariance.hpp"
#include "leeway/covariance/transition.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {
namespace {

constexpr double kBridgeTurnRadps = 0.5;
constexpr double kBridgeMaxTurnRad = 1.8;  // anywhere on the circle: pi / sqrt(3)
constexpr double kBridgeTiltRad = 0.1;     // roads lean; they do not turn vehicles over
constexpr double kBridgeAccelerationMps2 = 3.0;

/// Adds what a vehicle may have done over the last dt_s of a time in which nobody looked.
void add_unseen_motion(ErrorMatrix& P, const Eigen::Vector3d& r_e_m, double dt_s, double before_s) {
  const auto added = [&](auto&& sigma) {
    return std::pow(sigma(before_s + dt_s), 2) - std::pow(sigma(before_s), 2);
  };
  const double turn_rad2 = added(unseen_turn_rad);
  const double tilt_rad2 =
      added([](double t_s) { return std::min(kBridgeTurnRadps * t_s, kBridgeTiltRad); });
  const double velocity_m2ps2 = added([](double t_s) { return kBridgeAccelerationMps2 * t_s; });
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(r_e_m));
  const Eigen::Vector3d psi_n_rad2(tilt_rad2, tilt_rad2, turn_rad2);
  const Eigen::Matrix3d psi_e_rad2 = C_en * psi_n_rad2.asDiagonal() * C_en.transpose();
  P.block<3, 3>(kPsi, kPsi) += 0.5 * (psi_e_rad2 + psi_e_rad2.transpose());
  P.diagonal().segment<3>(kDv).array() += velocity_m2ps2;
  P.diagonal().segment<3>(kDr).array() += velocity_m2ps2 * dt_s * dt_s / 3.0;
  P.block<3, 3>(kDv, kDr).diagonal().array() += 0.5 * velocity_m2ps2 * dt_s;
  P.block<3, 3>(kDr, kDv).diagonal().array() += 0.5 * velocity_m2ps2 * dt_s;
}

}  // namespace

double unseen_turn_rad(double dt_s) { return std::min(kBridgeTurnRadps * dt_s, kBridgeMaxTurnRad); }

void widen(Belief& belief, double factor) {
  belief.P *= factor;
  if (!belief.vehicle) return;
  belief.vehicle->P *= factor;
  belief.vehicle->cross *= factor;
}

void restart_motion(Belief& belief, const Eigen::Vector3d& r_e_m, const Eigen::Matrix3d& P_rr_m2,
                    const Eigen::Vector3d& v_e_mps, const Eigen::Matrix3d& P_vv_m2ps2) {
  belief.estimate.nav.r_e_m = r_e_m;
  belief.estimate.nav.v_e_mps = v_e_mps;
  belief.P.middleRows<6>(kDv).setZero();
  belief.P.middleCols<6>(kDv).setZero();
  belief.P.block<3, 3>(kDv, kDv) = P_vv_m2ps2;
  belief.P.block<3, 3>(kDr, kDr) = P_rr_m2;
  if (belief.vehicle) belief.vehicle->cross.middleRows<6>(kDv).setZero();
}

void make_positive_definite(ErrorMatrix& P) {
  constexpr double kFloor = 1e-9;
  const ErrorVector sigma = P.diagonal().cwiseAbs().cwiseSqrt().cwiseMax(1e-12);
  const ErrorVector inverse = sigma.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<ErrorMatrix> eigen(
      ErrorMatrix(inverse.asDiagonal() * P * inverse.asDiagonal()));
  const ErrorVector raised = eigen.eigenvalues().cwiseMax(kFloor);
  const ErrorMatrix columns = eigen.eigenvectors() * raised.asDiagonal();
  const ErrorMatrix correlation = columns.lazyProduct(eigen.eigenvectors().transpose());
  P = sigma.asDiagonal() * correlation * sigma.asDiagonal();
  P = (0.5 * (P + P.transpose())).eval();
}

void bridge(Belief& belief, Time to, const ProcessNoise& noise, double before_s) {
  NavState& nav = belief.estimate.nav;
  const double dt_s = to_seconds(to - nav.time);
  nav.r_e_m += dt_s * nav.v_e_mps;
  nav.time = to;
  Transition Phi;
  Phi.dt_s = dt_s;
  Phi.r.middleCols<3>(kDv) = dt_s * Eigen::Matrix3d::Identity();
  propagate(belief.P, Phi, noise);
  if (belief.vehicle) propagate(*belief.vehicle, Phi);
  add_unseen_motion(belief.P, nav.r_e_m, dt_s, before_s);
}

bool is_sane(const Estimate& estimate, const ErrorMatrix& P) {
  constexpr double kLargest = 1e30;
  const double sizes = estimate.nav.r_e_m.squaredNorm() + estimate.nav.v_e_mps.squaredNorm() +
                       estimate.nav.q_eb.squaredNorm() + estimate.bias.b_a_mps2.squaredNorm() +
                       estimate.bias.b_g_radps.squaredNorm();
  return sizes < kLargest && P.cwiseAbs().sum() < kLargest;
}

}  // namespace leeway
