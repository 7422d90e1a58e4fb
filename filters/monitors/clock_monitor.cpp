#include "leeway/monitors/clock_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "leeway/earth/earth.hpp"
#include "leeway/model/gnss_measurement.hpp"

namespace leeway {
namespace {

constexpr double kClosestS = 0.25;  // what comes more often tells no more of a motion
constexpr double kApartSigmas = 3.0;

double sigma_of(const Eigen::Matrix3d& R) { return std::sqrt(R.trace() / 3.0); }

}  // namespace

void ClockMonitor::push(const ImuIncrement& inc, const Estimate& estimate) {
  if (!has_begun_) {
    begun_ = inc.time;
    has_begun_ = true;
  }
  const NavState& nav = estimate.nav;
  down_e_ = -nav.r_e_m.normalized();
  const Eigen::Vector3d coriolis_e_mps2 =
      2.0 * wgs84::kRotationRateRadps * Eigen::Vector3d(nav.v_e_mps.y(), -nav.v_e_mps.x(), 0.0);
  const Eigen::Vector3d dv_e_mps = nav.q_eb * (inc.dv_b_mps - inc.dt_s * estimate.bias.b_a_mps2) +
                                   inc.dt_s * (kStandardGravityMps2 * down_e_ + coriolis_e_mps2);
  motion_.t_s = to_seconds(inc.time - begun_);
  motion_.way_e_m += inc.dt_s * (motion_.v_e_mps + 0.5 * dv_e_mps);
  motion_.v_e_mps += dv_e_mps;
  if (count_ > 0 && motion_.t_s - point(0).t_s + 0.5 * inc.dt_s < kStepS) return;

  const Eigen::Vector3d omega_ib_b_radps = inc.dtheta_b_rad / inc.dt_s;
  rate_e_radps_ = nav.q_eb * (omega_ib_b_radps - estimate.bias.b_g_radps);
  Motion antenna = motion_;
  antenna.way_e_m += antenna_position_e(estimate, lever_arm_b_m_) - nav.r_e_m;
  antenna.v_e_mps += antenna_velocity_e(estimate, lever_arm_b_m_, omega_ib_b_radps) - nav.v_e_mps;
  if (count_ > 0) {
    acceleration_e_mps2_ = (antenna.v_e_mps - point(0).v_e_mps) / (antenna.t_s - point(0).t_s);
  }
  newest_ = (newest_ + 1) % kPoints;
  points_[newest_] = antenna;
  count_ = std::min(count_ + 1, kPoints);
  while (waiting_count_ > 0 && waiting_[0].t_s + AgeGrid::kLargestS < antenna.t_s) {
    compare(waiting_[0]);
    std::move(waiting_.begin() + 1, waiting_.end(), waiting_.begin());
    --waiting_count_;
  }
}

void ClockMonitor::push(const GnssFix& fix) {
  if (!has_begun_) return;
  if (fix.velocity) {
    wait(fix.time, true, fix.velocity->v_e_mps, sigma_of(fix.velocity->R_e_m2ps2));
  }
  if (fix.position) {
    if (origin_e_m_.isZero(0.0)) origin_e_m_ = fix.position->r_e_m;
    wait(fix.time, false, fix.position->r_e_m - origin_e_m_, sigma_of(fix.position->R_e_m2));
  }
}

void ClockMonitor::wait(Time time, bool is_velocity, const Eigen::Vector3d& value, double sigma) {
  const double t_s = to_seconds(time - begun_);
  double& last_s = last_s_[is_velocity ? 1 : 0];
  if (waiting_count_ == kWaiting || t_s < last_s + kClosestS) return;
  last_s = t_s;
  waiting_[waiting_count_++] = {t_s, is_velocity, value, sigma};
}

void ClockMonitor::restart() {
  count_ = 0;
  waiting_count_ = 0;
  motion_ = {};
  has_position_ = false;
  velocities_.restart();
  positions_.restart();
}

// The points are walked through once, from the newest on: ages grow from younger to older.
std::optional<LagFit::Pairs> ClockMonitor::beside_motion(const Measured& measured) const {
  if (count_ < 2 || point(count_ - 1).t_s > measured.t_s - AgeGrid::kLargestS) return {};
  LagFit::Pairs pairs;
  std::size_t after = 0;
  for (std::size_t k = 0; k < AgeGrid::kCount; ++k) {
    const double then_s = measured.t_s - AgeGrid::at(k);
    while (after + 2 < count_ && point(after + 1).t_s > then_s) ++after;
    const Motion& to = point(after);
    const Motion& from = point(after + 1);
    const double step_s = to.t_s - from.t_s;
    const double share = (then_s - from.t_s) / step_s;
    const Eigen::Vector3d v_e_mps = from.v_e_mps + share * (to.v_e_mps - from.v_e_mps);
    const Eigen::Vector3d way_e_m = from.way_e_m + share * (to.way_e_m - from.way_e_m);
    pairs[k] = {measured.value, measured.is_velocity ? v_e_mps : way_e_m, v_e_mps};
    if (measured.is_velocity) pairs[k].slope = (to.v_e_mps - from.v_e_mps) / step_s;
  }
  return pairs;
}

void ClockMonitor::compare(const Measured& measured) {
  const auto pairs = beside_motion(measured);
  if (!pairs) return;
  if (measured.is_velocity) {
    velocities_.add(*pairs, down_e_, measured.sigma, measured.t_s);
  } else {
    compare_way(*pairs, measured);
  }
  judge();
}

// The way between two positions is a velocity.
void ClockMonitor::compare_way(const LagFit::Pairs& pairs, const Measured& position) {
  const double dt_s = position.t_s - last_position_s_;
  if (has_position_ && dt_s > 0.0) {
    LagFit::Pairs ways;
    for (std::size_t k = 0; k < AgeGrid::kCount; ++k) {
      const LagFit::Pair& last = last_position_[k];
      ways[k] = {(pairs[k].measured - last.measured) / dt_s, (pairs[k].motion - last.motion) / dt_s,
                 (pairs[k].slope - last.slope) / dt_s};
    }
    positions_.add(ways, down_e_, std::numbers::sqrt2 * position.sigma / dt_s, position.t_s);
  }
  last_position_ = pairs;
  last_position_s_ = position.t_s;
  has_position_ = true;
}

// The velocities tell more, and the positions whose fault it is.
void ClockMonitor::judge() {
  const Age& velocity = velocities_.age();
  const Age& position = positions_.age();
  const bool by_velocity = velocity.sigma_s <= position.sigma_s;
  offset_.age = by_velocity ? velocity : position;
  const double apart_s = std::hypot(velocity.sigma_s, position.sigma_s) * kApartSigmas;
  offset_.of_velocity = velocity.beyond_chance && !position.beyond_chance &&
                        std::abs(velocity.value_s - position.value_s) > apart_s;
  if (offset_.of_velocity) offset_.age = velocity;
}

void ClockMonitor::take_out() {
  taken_out_s_ += FixAge(offset_.of_velocity ? 0.0 : 1.0, 1.0) * offset_.age.value_s;
  left_sigma_s_ = offset_.age.sigma_s;
  offset_ = {};
  restart();
  velocities_ = LagFit{};
  positions_ = LagFit{};
}

ErrorMatrix ClockMonitor::covariance(const Estimate& estimate) const {
  const double sigma_s = offset_.age.beyond_chance
                             ? std::hypot(offset_.age.value_s, offset_.age.sigma_s)
                             : left_sigma_s_;
  ErrorVector by_age = ErrorVector::Zero();
  by_age.segment<3>(kPsi) = rate_e_radps_;
  by_age.segment<3>(kDv) = acceleration_e_mps2_;
  by_age.segment<3>(kDr) = estimate.nav.v_e_mps;
  return sigma_s * sigma_s * by_age * by_age.transpose();
}

}  // namespace leeway
