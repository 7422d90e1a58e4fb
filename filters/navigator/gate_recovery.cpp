#include "leeway/navigator/gate_recovery.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/model/gnss_measurement.hpp"

namespace leeway {
namespace {

// An IMU or a model that fails once in a quarter of an hour, against one fix in a hundred that is
// wrong: the odds that a refusal is the filter's fault grow with the time since a fix confirmed it.
constexpr double kOddsPerS = 0.1;
// A filter whose velocity is right has not drifted away: where the position alone is refused, the
// fixes before have been wrong for long, if not this one. That is rarer, once in some hours.
constexpr double kPositionOddsPerS = 0.01;
constexpr double kLowestOdds = 0.01;
constexpr double kSigmas = 5.0;
constexpr double kLongestMemoryS = 300.0;  // being right for longer proves no more
constexpr double kLargestTurnRad = 1.8;    // of an attitude that is anywhere: pi / sqrt(3)
constexpr double kLargestForceMps2 = 20.0;  // of a bias: gravity with the wrong sign
constexpr double kLargestRateRadps = 0.5;   // ... a vehicle's own rate with the wrong sign

/// Shrinks the variances of three errors to what they can be at all.
void hold_below(ErrorMatrix& P, int block, double sigma) {
  for (int i = block; i < block + 3; ++i) {
    const double shrunk = std::min(1.0, sigma / std::sqrt(P(i, i)));
    P.row(i) *= shrunk;
    P.col(i) *= shrunk;
  }
}

double largest_sigma(const Eigen::Matrix3d& P) { return std::sqrt(P.diagonal().maxCoeff()); }

}  // namespace

void GateRecovery::begin(Time t) {
  good_since_ = t;
  good_time_.reset();
  refused_since_.reset();
  rival_since_.reset();
  rival_.reset();
}

void GateRecovery::fused(const GnssFix& fix, const Ekf& filter) {
  refused_since_.reset();
  rival_since_.reset();
  rival_.reset();
  good_time_ = fix.time;
  good_r_e_m_ = antenna_position_e(filter.estimate(), filter.inertial().config().lever_arm_b_m);
  good_v_e_mps_ = filter.estimate().nav.v_e_mps;
  const ErrorMatrix& P = filter.kernel().matrix();
  good_sigma_m_ = largest_sigma(P.block<3, 3>(kDr, kDr));
  good_sigma_mps_ = largest_sigma(P.block<3, 3>(kDv, kDv));
}

bool GateRecovery::is_reachable(const GnssFix& fix) const {
  if (!good_time_) return true;
  const double dt_s = to_seconds(fix.time - *good_time_);
  if (!(dt_s >= 0.0)) return false;
  const double gained_mps = std::min(limits_.acceleration_mps2 * dt_s, 2.0 * limits_.speed_mps);
  if (fix.position) {
    const double off_m =
        (fix.position->r_e_m - good_r_e_m_ - dt_s * good_v_e_mps_).norm();
    const double sigma_m = std::hypot(good_sigma_m_, largest_sigma(fix.position->R_e_m2),
                                      dt_s * good_sigma_mps_);
    if (off_m > 0.5 * gained_mps * dt_s + kSigmas * sigma_m) return false;
  }
  if (!fix.velocity) return true;
  const double sigma_mps = std::hypot(good_sigma_mps_, largest_sigma(fix.velocity->R_e_m2ps2));
  return (fix.velocity->v_e_mps - good_v_e_mps_).norm() <= gained_mps + kSigmas * sigma_mps;
}

bool GateRecovery::continues_rival(const GnssFix& fix) const {
  if (!rival_ || !rival_->position || !fix.position) return false;
  const double dt_s = to_seconds(fix.time - rival_->time);
  const double gained_mps = std::min(limits_.acceleration_mps2 * dt_s, 2.0 * limits_.speed_mps);
  const Eigen::Vector3d v_e_mps = rival_->velocity ? rival_->velocity->v_e_mps : good_v_e_mps_;
  const double off_m = (fix.position->r_e_m - rival_->position->r_e_m - dt_s * v_e_mps).norm();
  const double sigma_m =
      std::hypot(largest_sigma(rival_->position->R_e_m2), largest_sigma(fix.position->R_e_m2));
  return off_m <= 0.5 * gained_mps * dt_s + kSigmas * sigma_m;
}

double GateRecovery::odds_of(const GnssFix& fix, bool position_alone) {
  if (!refused_since_) refused_since_ = fix.time;
  if (!fix.position) return 0.0;
  if (!continues_rival(fix)) rival_since_ = fix.time;
  rival_ = fix;
  const double unconfirmed_s = to_seconds(fix.time - good_time_.value_or(good_since_));
  const double good_s =
      std::min(to_seconds(good_time_.value_or(good_since_) - good_since_), kLongestMemoryS);
  const bool has_outlived = to_seconds(fix.time - *rival_since_) > good_s;
  if (!is_reachable(fix) && !has_outlived) return 0.0;
  if (has_outlived) return 1.0;
  const double odds_per_s = position_alone ? kPositionOddsPerS : kOddsPerS;
  return std::clamp(odds_per_s * unconfirmed_s, kLowestOdds, 1.0);
}

Ekf rival_of(const Ekf& filter, const GnssFix& fix, const UpdateOutcome& refusal,
             double unseen_mps) {
  constexpr double kLargestWidening = 100.0;  // of variances: ten times the sigma
  constexpr double kNoise = 2.0;              // on the sigma of the IMU's noise
  // Where the vehicle is comes first. Attitude and biases are doubted when that did not do.
  const double scale = filter.inertial().noise_scale();
  const double widening =
      scale > 1.0 ? std::clamp(refusal.nis / refusal.gate, 2.0, kLargestWidening) : 1.0;
  const NavState& nav = filter.estimate().nav;
  const Eigen::Vector3d& lever_b_m = filter.inertial().config().lever_arm_b_m;
  const Eigen::Vector3d r_e_m = fix.position->r_e_m - nav.q_eb * lever_b_m;
  Ekf rival = filter;
  if (refuses_position_alone(refusal)) {
    edit(rival, [&](Belief& belief) {
      const Eigen::Matrix3d P_vv = belief.P.block<3, 3>(kDv, kDv);
      restart_motion(belief, r_e_m, fix.position->R_e_m2, nav.v_e_mps, P_vv);
    });
    return rival;
  }
  const Eigen::Matrix3d unseen = unseen_mps * unseen_mps * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d antenna_e_mps =
      antenna_velocity_e(filter.estimate(), lever_b_m, filter.inertial().omega_ib_b_radps());
  const Eigen::Vector3d v_e_mps =
      fix.velocity ? Eigen::Vector3d(fix.velocity->v_e_mps - antenna_e_mps + nav.v_e_mps)
                   : nav.v_e_mps;
  edit(rival, [&](Belief& belief) {
    widen(belief, widening);
    hold_below(belief.P, kPsi, kLargestTurnRad);
    hold_below(belief.P, kBa, kLargestForceMps2);
    hold_below(belief.P, kBg, kLargestRateRadps);
    restart_motion(belief, r_e_m, fix.position->R_e_m2, v_e_mps,
                   fix.velocity ? fix.velocity->R_e_m2ps2 : unseen);
  });
  rival.scale_imu_noise(std::min(kNoise * scale, kLargestImuScale));
  return rival;
}

bool refuses_position_alone(const UpdateOutcome& refusal) {
  return refusal.fused_in_part && refusal.position_nis > refusal.velocity_nis;
}

}  // namespace leeway
