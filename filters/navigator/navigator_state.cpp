#include "leeway/navigator/navigator_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "filters/navigator/heading_spread.hpp"
#include "leeway/model/heading.hpp"

namespace leeway {
namespace {

EkfConfig filter_of(const NavigatorConfig& config) {
  EkfConfig filter = config.filter;
  if (!config.C_bs) filter.lever_arm_b_m.setZero();  // where it points is not known yet
  return filter;
}

Aligner aligner_of(const NavigatorConfig& config) {
  AlignmentConfig alignment = config.alignment;
  alignment.sideslip_rad =
      std::hypot(alignment.sideslip_rad, limits_of(config.vehicle.kind).drift_rad);
  // A bank of headings with the non-holonomic constraint finds the course as the heading by itself,
  // slip and turns included.
  if (!config.C_bs || config.vehicle.non_holonomic ||
      !limits_of(config.vehicle.kind).goes_where_it_points) {
    alignment.heading_from_course = false;
  }
  return Aligner(alignment, filter_of(config));
}

ImuIncrement turned(const ImuIncrement& inc, const Eigen::Matrix3d& C_bs) {
  ImuIncrement result = inc;
  result.dtheta_b_rad = C_bs * inc.dtheta_b_rad;
  result.dv_b_mps = C_bs * inc.dv_b_mps;
  return result;
}

}  // namespace

HeadingBank NavigatorState::any_bank() const {
  return HeadingBank(filter_anywhere(filter_of(config_)));
}

NavigatorState::NavigatorState(const NavigatorConfig& config)
    : config_(config),
      aligner_(aligner_of(config)),
      aiding_(config.vehicle, config.filter.imu),
      course_(config.alignment.sideslip_rad, limits_of(config.vehicle.kind).drift_rad),
      C_bs_(config.C_bs),
      gate_recovery_(limits_of(config.vehicle.kind)) {
  validate(config);
}

void NavigatorState::start(const Estimate& estimate, const ErrorMatrix& P) {
  const double variance_rad2 = heading_variance_rad2(estimate, P);
  const double sigma_rad = std::sqrt(std::max(0.0, variance_rad2));
  begin(sigma_rad > HeadingBank::kOneFilterRad
            ? bank_around(filter_of(config_), estimate, P, sigma_rad)
            : HeadingBank(Ekf(filter_of(config_), estimate, P)));
}

void NavigatorState::widen(const ErrorMatrix& covariance) {
  bank_->for_each(
      [&](Ekf& filter) { edit(filter, [&](Belief& belief) { belief.P += covariance; }); });
}

void NavigatorState::begin(const HeadingBank& bank) {
  bank_ = bank;
  last_fused_ = bank_->best().estimate().nav.time;
  gate_recovery_.begin(*last_fused_);
  if (C_bs_) begin_vehicle();
}

void NavigatorState::begin_vehicle() {
  if (!config_.vehicle.uses_parameters()) return;
  VehicleState vehicle = vehicle_state(config_.vehicle);
  if (!config_.C_bs) {
    // A mount that was found is as good as the heading was.
    constexpr double kFound = MountEstimator::kMaxHeadingSigmaRad;
    for (const int angle : {kMountPitch, kMountYaw}) {
      vehicle.P(angle, angle) = std::max(vehicle.P(angle, angle), kFound * kFound);
    }
  }
  bank_->for_each(
      [&](Ekf& filter) { edit(filter, [&](Belief& belief) { belief.vehicle = vehicle; }); });
}

void NavigatorState::integrate(const ImuIncrement& inc) {
  const ImuIncrement in_body = C_bs_ ? turned(inc, *C_bs_) : inc;
  if (!bank_) return aligner_.push(in_body);
  constexpr double kMemsRadPerSqrtS = 2e-5;  // 0.07 deg per root hour: less is no MEMS gyro
  const bool is_mems = config_.filter.imu.gyro.noise_density > kMemsRadPerSqrtS;
  if (is_mems && imu_screen_.is_held(inc) && moves()) {
    contradicted_ = inc.time;
    return bridge(inc.time);
  }
  end_hole();
  if (is_starting_beside_) aligner_.push(in_body);
  bank_->for_each([&](Ekf& filter) { filter.predict(in_body); });
  coast_.push(in_body);
  const bool rested = aiding_.at_rest();
  if (aiding_.push(in_body, *bank_)) {
    contradicted_ = inc.time;
    doubt_heading(bank_->best(), bank_->best());
  }
  if (rested && !aiding_.at_rest()) open_heading();
  // From numbers that were sound when P was last propagated, a few samples cannot reach infinity.
  if (bank_->best().covariance_is_current() && !is_sane(*bank_)) realign();
}

void NavigatorState::open_heading() {
  if (!bank_->collapsed()) return;
  const double sigma_rad = heading_sigma_rad(bank_->best());
  if (!(sigma_rad > HeadingBank::kOneFilterRad)) return;
  if (const auto headings = bank_of_headings(bank_->best(), sigma_rad)) bank_ = *headings;
}

void NavigatorState::bridge(Time to) {
  if (!bank_) {
    // What was collected before a hole says nothing about the attitude after it.
    aligner_ = aligner_of(config_);
    return;
  }
  coast_.restart();
  const double dt_s = to_seconds(to - bank_->best().estimate().nav.time);
  bank_->for_each([&](Ekf& filter) { leeway::bridge(filter, to, hole_s_); });
  hole_s_ += dt_s;
}

// The course has turned along with the heading. In one linear filter the constraint would tell the
// one by the other, and both are as wrong.
void NavigatorState::end_hole() {
  const double hole_s = std::exchange(hole_s_, 0.0);
  if (hole_s == 0.0 || !config_.vehicle.non_holonomic || !bank_->collapsed()) return;
  const Ekf& filter = bank_->best();
  if (const auto headings = bank_of_headings(filter, heading_sigma_rad(filter), hole_s)) {
    bank_ = *headings;
  }
}

Verdict NavigatorState::fuse(const Reading& reading) {
  return std::visit([this](const auto& r) { return take(r); }, reading);
}

template <AidingReading R>
Verdict NavigatorState::take(const R& reading) {
  if (!(config_.vehicle.*R::kIsOn)) return Verdict::kUnused;
  if (!bank_ || !C_bs_) return Verdict::kAligning;
  const UpdateOutcome update = bank_->update([&](Ekf& filter) {
    return filter.update(measurement(reading, filter.estimate(), filter.vehicle()->value,
                                     filter.inertial().omega_ib_b_radps()));
  });
  return update.outcome == UpdateOutcome::Outcome::kFused ? Verdict::kFused : Verdict::kGated;
}

bool NavigatorState::motion_hides_heading(Time t) const {
  return leeway::motion_hides_heading(config_.vehicle, aiding_.at_rest(), aiding_.even_motion_s(),
                                      to_seconds(t - last_fused_.value_or(t)));
}

bool NavigatorState::moves() const {
  constexpr double kMovingMps = 0.5;
  if (!bank_) return false;
  const Ekf& filter = bank_->best();
  const double sigma_mps = std::sqrt(filter.kernel().matrix().diagonal().segment<3>(kDv).sum());
  return filter.estimate().nav.v_e_mps.norm() > kMovingMps + 3.0 * sigma_mps;
}

// The IMU may be right again, or it was the attitude that was wrong: where the IMU is taken for a
// far noisier one than it is, a second start is weighed against the filter. One from fixes far
// apart is a guess: the tilt of some degrees that it leaves is 10 m after 5 s.
void NavigatorState::start_beside(const GnssFix& fix, double fix_interval_s) {
  constexpr double kDoubtedScale = 4.0;
  constexpr double kBrokenScale = 100.0;  // no other attitude would mend it
  const double scale = bank_->best().inertial().noise_scale();
  if (!bank_->collapsed() || scale < kDoubtedScale || scale > kBrokenScale ||
      was_opened(fix.time) || fix_interval_s > config_.alignment.max_fix_interval_s) {
    is_starting_beside_ = false;
    return;
  }
  if (!is_starting_beside_) aligner_ = aligner_of(config_);
  is_starting_beside_ = true;
  const auto found = aligner_.push(fix);
  if (!found || !can_start(found->estimate, found->P)) return;
  const Ekf filter = bank_->best();
  bank_ = HeadingBank(filter.inertial().config(), found->estimate, found->P, found->axis_e,
                      found->turn_sigma_rad);
  if (C_bs_) begin_vehicle();
  // As likely as all of the others together, and the best until they explain the fixes better.
  bank_->add(filter, HeadingBank::kMaxHeadings);
  heading_doubted_ = fix.time;
  is_starting_beside_ = false;
}

void NavigatorState::align(const GnssFix& fix) {
  const auto found = aligner_.push(fix);
  if (!found || !can_start(found->estimate, found->P)) return;
  begin(HeadingBank(filter_of(config_), found->estimate, found->P, found->axis_e,
                    found->turn_sigma_rad));
  // Whatever goes where it points may be backing.
  constexpr double kBackingOdds = 0.02;
  constexpr double kHalfTurnRad = 180.0 * kRadPerDeg;
  if (!bank_->collapsed() || !found->from_course) return;
  Estimate backing = found->estimate;
  backing.nav.q_eb = exp_quaternion(kHalfTurnRad * found->axis_e) * backing.nav.q_eb;
  bank_->add(Ekf(filter_of(config_), backing, found->P), kBackingOdds);
}

void NavigatorState::realign() {
  ++realignments_;
  contradicted_ = bank_->best().estimate().nav.time;
  bank_.reset();
  coast_ = CoastMonitor{};
  aligner_ = aligner_of(config_);
  C_bs_ = config_.C_bs;
  mount_ = MountEstimator{};
}

void NavigatorState::find_mount() {
  mount_.push(*bank_);
  const auto C_bs = mount_.C_bs();
  if (!C_bs) return;
  bank_->for_each([&](Ekf& filter) { filter.turn_body_axes(*C_bs, config_.filter.lever_arm_b_m); });
  C_bs_ = C_bs;
  coast_.restart();
  begin_vehicle();
}

}  // namespace leeway
