#include "leeway/monitors/clock_monitor.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "filters/covariance/cholesky.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway {
namespace {

// Variance per second by which the ages walk. A crystal drifts by 20 ppm: 2 ms in 100 s.
constexpr double kCrystalS2PerS = 4e-8;
constexpr double kLastingS = 300.0;  // what is older counts by less than a third
constexpr double kMostUnknownS2 = 1.0;
constexpr double kLeastClockOffsetS = 0.02;  // receivers smooth by as much
constexpr double kBeyondChanceSigmas = 5.0;
constexpr double kOfVelocityOdds = 9.0;  // squared sigmas by which the velocity alone explains more
constexpr double kNisWindow = 60.0;      // components of fixes
constexpr double kLargestUnexplained = 100.0;
constexpr double kLeastFollowedS = 0.001;
constexpr double kLargestTakenOutS = 5.0;
constexpr double kSettlesS = 10.0;    // until it no longer matters where U began
constexpr double kKnownS2 = 0.25;     // an age of which something is known
constexpr double kShortStepS = 0.03;  // tells no acceleration

}  // namespace

/// A measurement in rows of unit variance, zero beyond those there are, with the gain that it was
/// fused with. Of a filter's covariance P after it, K = P H^T and S^-1 = 1 - H P H^T.
struct ClockMonitor::Rows {
  Rows(const Measurement& m, const Eigen::Matrix<double, 6, 2>& by_age, double position_weight,
       const Ekf& filter);

  void leave_held(Held held, const Estimate& estimate);

  int count;
  Eigen::Matrix<double, 6, kJointStates> H{Eigen::Matrix<double, 6, kJointStates>::Zero()};
  Eigen::Matrix<double, 6, 2> G;  // by the ages
  Eigen::Matrix<double, 6, 1> z{Eigen::Matrix<double, 6, 1>::Zero()};
  Eigen::Matrix<double, kJointStates, 6> K{Eigen::Matrix<double, kJointStates, 6>::Zero()};
  Eigen::Matrix<double, 6, 6> S_inverse{Eigen::Matrix<double, 6, 6>::Identity()};
};

ClockMonitor::Rows::Rows(const Measurement& m, const Eigen::Matrix<double, 6, 2>& by_age,
                         double position_weight, const Ekf& filter)
    : count(m.rows()), G(by_age) {
  H.topLeftCorner(count, kErrorStates) = m.H;
  H.topRightCorner(count, kVehicleStates) = m.H_vehicle;
  z.head(count) = m.innovation;
  const Cholesky<6> R_factor(m.R);
  R_factor.whiten(H);
  R_factor.whiten(G);
  R_factor.whiten(z);
  if (position_weight != 1.0) {
    H.topRows<3>() *= position_weight;
    G.topRows<3>() *= position_weight;
    z.head<3>() *= position_weight;
  }
  const auto H_x = H.leftCols<kErrorStates>();
  const auto H_y = H.rightCols<kVehicleStates>();
  K.topRows<kErrorStates>() = filter.kernel().matrix() * H_x.transpose();
  if (const auto& vehicle = filter.vehicle()) {
    K.topRows<kErrorStates>() += vehicle->cross * H_y.transpose();
    K.bottomRows<kVehicleStates>() =
        vehicle->cross.transpose() * H_x.transpose() + vehicle->P * H_y.transpose();
  }
  S_inverse -= H * K;
}

/// Takes the directions out of the gain that the update has left alone.
void ClockMonitor::Rows::leave_held(Held held, const Estimate& estimate) {
  if (held == Held::kNothing) return;
  const Eigen::Vector3d down_e = down_e_at(estimate.nav.r_e_m);
  const auto leave = [this](int first, const Eigen::Vector3d& direction) {
    K.middleRows<3>(first) -= direction * (direction.transpose() * K.middleRows<3>(first)).eval();
  };
  leave(kPsi, down_e);
  if (held == Held::kHeadingAndTurn) leave(kBg, estimate.nav.q_eb.conjugate() * down_e);
}

void ClockMonitor::Track::forget(double factor, double variance_s2) {
  M_s2 *= factor;
  M_s2.diagonal().array() += variance_s2;
  for (int k = 0; k < 2; ++k) {
    const double excess = M_s2(k, k) / kMostUnknownS2;
    if (excess <= 1.0) continue;
    M_s2.row(k) /= std::sqrt(excess);
    M_s2.col(k) /= std::sqrt(excess);
  }
}

/// Friedland (1969) (31)-(38), for a filter that has fused the rows with their gain.
/// @param nis_scale  of what is left; 0: the innovation is not looked at
/// @returns nis of the rows
double ClockMonitor::Track::pass(const Rows& rows, double nis_scale) {
  const Eigen::Matrix<double, 6, 2> V = rows.H * U + rows.G;
  const Eigen::Matrix<double, 6, 1> expected = rows.H * error + rows.G * age_s;
  U -= rows.K * V;
  error -= rows.K * expected;
  if (nis_scale == 0.0) return 0.0;
  const Eigen::Matrix<double, 6, 1> left = rows.z - expected;
  const Eigen::Matrix<double, 2, 6> by_S = V.transpose() * rows.S_inverse / nis_scale;
  const Eigen::Matrix2d information = by_S * V;
  const bool is_sound =
      information(0, 0) >= 0.0 && information(1, 1) >= 0.0 && information.determinant() >= 0.0;
  if (is_sound) {
    M_s2 = (M_s2.inverse() + information).inverse().eval();
    M_s2 = (0.5 * (M_s2 + M_s2.transpose())).eval();
    const FixAge change_s = M_s2 * (by_S * left);
    age_s += change_s;
    error += U * change_s;
  }
  return left.dot(rows.S_inverse * left);
}

void ClockMonitor::reach(const Ekf& filter) {
  const double dt_s = since_step_s_;
  since_step_s_ = 0.0;
  if (dt_s == 0.0) return;
  const Estimate& estimate = filter.estimate();
  const Eigen::Vector3d dv_e_mps = estimate.nav.v_e_mps - v_e_mps_;
  v_e_mps_ = estimate.nav.v_e_mps;
  changes_.feel(dv_e_mps);
  if (dt_s > kShortStepS) a_e_mps2_ = dv_e_mps / dt_s;
  if (!has_begun_) return;
  const Eigen::Matrix3d push =
      skew(dv_e_mps + dt_s * kStandardGravityMps2 * estimate.nav.r_e_m.normalized());
  const Eigen::Matrix3d C_dt = dt_s * estimate.nav.q_eb.toRotationMatrix();
  const auto propagate = [&](auto& X) {
    const auto dv =
        (push * X.template middleRows<3>(kPsi) + C_dt * X.template middleRows<3>(kBa)).eval();
    X.template middleRows<3>(kPsi) -= C_dt * X.template middleRows<3>(kBg);
    X.template middleRows<3>(kDr) += dt_s * (X.template middleRows<3>(kDv) - 0.5 * dv);
    X.template middleRows<3>(kDv) -= dv;
  };
  propagate(track_.U);
  propagate(track_.error);
}

void ClockMonitor::begin(const Eigen::Vector3d& v_e_mps) {
  track_.U.setZero();
  track_.U.block<3, 1>(kDr, 0) = v_e_mps;
  track_.U.block<3, 1>(kDv, 1) = a_e_mps2_;
  track_.error = track_.U * track_.age_s;
  has_begun_ = true;
}

// The innovations tell how far the filter has followed.
void ClockMonitor::begin_anew(const Eigen::Vector3d& v_e_mps, const UpdateOutcome& outcome) {
  begin(v_e_mps);
  track_.error.segment<3>(kDr) += outcome.position_innovation_e_m;
  track_.error.segment<3>(kDv) += outcome.velocity_innovation_e_mps;
}

void ClockMonitor::set_anew(double age_s, double sigma_s) {
  constexpr double kApartS2 = 0.05 * 0.05;  // of one part's age against the other's
  track_.age_s.setConstant(age_s);
  track_.M_s2.setConstant(sigma_s * sigma_s);
  track_.M_s2.diagonal().array() += 0.5 * kApartS2;
  changes_ = VelocityChanges{};
  offset_ = fit();
}

void ClockMonitor::rest(const Ekf& filter) {
  v_e_mps_ = filter.estimate().nav.v_e_mps;
  a_e_mps2_.setZero();
  track_.U.middleRows<3>(kDv).setZero();
  track_.error.segment<3>(kDv).setZero();
}

void ClockMonitor::take(const Measurement& m, const Ekf& filter) {
  v_e_mps_ = filter.estimate().nav.v_e_mps;
  if (!has_begun_) return;
  const Rows rows(m, Eigen::Matrix<double, 6, 2>::Zero(), 1.0, filter);
  track_.pass(rows, 0.0);
}

void ClockMonitor::take(const GnssFix& fix, const UpdateOutcome& outcome, const FixTrust& trust,
                        const Ekf& filter, bool is_sound) {
  v_e_mps_ = filter.estimate().nav.v_e_mps;
  const InertialEstimate& inertial = filter.inertial();
  const Eigen::Vector3d antenna_e_mps = antenna_velocity_e(
      filter.estimate(), inertial.config().lever_arm_b_m, inertial.omega_ib_b_radps());
  if (fix.velocity) {
    changes_.push(fix, a_e_mps2_, antenna_e_mps - v_e_mps_, down_e_at(filter.estimate().nav.r_e_m));
    const auto age = changes_.other_than(track_.age_s(1));
    if (age && track_.M_s2(1, 1) < kKnownS2) {
      set_anew(age->value_s, age->sigma_s);
      begin_anew(antenna_e_mps, outcome);
    }
  }
  GnssFix part = fix;
  if (outcome.outcome != UpdateOutcome::Outcome::kFused) {
    if (!outcome.fused_in_part) return;
    outcome.position_nis > outcome.velocity_nis ? part.position.reset() : part.velocity.reset();
  }
  Measurement m = inertial.measurement(part);
  Eigen::Matrix<double, 6, 2> G = Eigen::Matrix<double, 6, 2>::Zero();
  double weight = 1.0;
  if (part.position) {
    if (!trust.is_white) weight = position_weight_.of(fix.time);
    position_weight_.fused(fix.time);
    m.innovation.head<3>() = outcome.position_innovation_e_m;
    m.R.topLeftCorner<3, 3>() *= trust.position_sigma_scale * trust.position_sigma_scale;
    G.block<3, 1>(0, 0) = -antenna_e_mps;
  }
  if (part.velocity) {
    m.innovation.tail<3>() = outcome.velocity_innovation_e_mps;
    m.R.bottomRightCorner<3, 3>() *= trust.velocity_sigma_scale * trust.velocity_sigma_scale;
    G.block<3, 1>(m.rows() - 3, 1) = -a_e_mps2_;
  }
  const double dt_s = std::max(0.0, to_seconds(fix.time - newest_));
  newest_ = fix.time;
  if (!has_begun_) {
    begun_ = fix.time;
    return begin(antenna_e_mps);
  }
  Rows rows(m, G, weight, filter);
  rows.leave_held(trust.held, filter.estimate());
  const bool has_settled = to_seconds(fix.time - begun_) >= kSettlesS;
  if (is_sound && has_settled) return learn(rows, dt_s);
  track_.pass(rows, 0.0);
}

void ClockMonitor::learn(const Rows& rows, double dt_s) {
  track_.forget(std::exp(dt_s / kLastingS), kCrystalS2PerS * dt_s);
  const double nis = track_.pass(rows, std::max(1.0, nis_ratio_));
  nis_ratio_ += (nis - rows.count * nis_ratio_) / kNisWindow;
  nis_ratio_ = std::clamp(nis_ratio_, 0.0, kLargestUnexplained);
  offset_ = fit();
}

/// Of both parts or of the velocity alone, whichever explains more.
ClockOffset ClockMonitor::fit() const {
  const Eigen::Matrix2d N = track_.M_s2.inverse();
  const FixAge total_s = taken_out_s_ + track_.age_s;
  const FixAge pull = N * total_s;
  const double both = N.sum();
  ClockOffset offset;
  const double nis_of_both = pull.sum() * pull.sum() / both;
  const double nis_of_velocity = pull(1) * pull(1) / N(1, 1);
  offset.of_velocity = nis_of_velocity > nis_of_both + kOfVelocityOdds;
  offset.value_s = offset.of_velocity ? pull(1) / N(1, 1) : pull.sum() / both;
  offset.sigma_s = 1.0 / std::sqrt(offset.of_velocity ? N(1, 1) : both);
  offset.age_s = {offset.of_velocity ? 0.0 : offset.value_s, offset.value_s};
  offset.beyond_chance =
      std::abs(offset.value_s) > std::max(kLeastClockOffsetS, kBeyondChanceSigmas * offset.sigma_s);
  return offset;
}

JointVector ClockMonitor::take_out() {
  is_followed_ = is_followed_ || offset_.beyond_chance;
  if (!is_followed_) return JointVector::Zero();
  const FixAge more_s =
      offset_.age_s.cwiseMax(-kLargestTakenOutS).cwiseMin(kLargestTakenOutS) - taken_out_s_;
  if (more_s.cwiseAbs().maxCoeff() < std::max(kLeastFollowedS, 0.3 * offset_.sigma_s)) {
    return JointVector::Zero();
  }
  JointVector correction = JointVector::Zero();
  if (has_begun_) correction = track_.error + track_.U * (more_s - track_.age_s);
  taken_out_s_ += more_s;
  changes_.take_out(more_s(1));
  track_.age_s -= more_s;
  track_.error -= correction;
  return correction;
}

ErrorMatrix ClockMonitor::covariance() const {
  if (!offset_.beyond_chance || !has_begun_) return ErrorMatrix::Zero();
  const Eigen::Matrix<double, kErrorStates, 2> U = track_.U.topRows<kErrorStates>();
  const FixAge more_s = offset_.age_s - taken_out_s_ - track_.age_s;
  const ErrorVector left = track_.error.head<kErrorStates>() + U * more_s;
  const FixAge one(offset_.of_velocity ? 0.0 : 1.0, 1.0);
  const ErrorVector by_sigma = U * one * offset_.sigma_s;
  return left * left.transpose() + by_sigma * by_sigma.transpose();
}

}  // namespace leeway
