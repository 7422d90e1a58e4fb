#include "leeway/navigator/navigator.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/error.hpp"
#include "leeway/model/claimed_solution.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway {
namespace {

constexpr Duration kFurthestTime = std::chrono::seconds{4'000'000'000};  // 127 years

bool all_finite(const GnssFix& fix) {
  return (!fix.position || (fix.position->r_e_m.allFinite() && fix.position->R_e_m2.allFinite())) &&
         (!fix.velocity ||
          (fix.velocity->v_e_mps.allFinite() && fix.velocity->R_e_m2ps2.allFinite()));
}

bool is_possible(Time t) {
  return t.time_since_epoch() <= kFurthestTime && t.time_since_epoch() >= -kFurthestTime;
}

/// The increment over a longer interval at the same mean rates: bridges a short hole.
ImuIncrement stretched(const ImuIncrement& inc, double dt_s) {
  ImuIncrement result = inc;
  result.dt_s = dt_s;
  result.dtheta_b_rad *= dt_s / inc.dt_s;
  result.dv_b_mps *= dt_s / inc.dt_s;
  return result;
}

Verdict judge(const ImuIncrement& inc, const NavigatorConfig& config) {
  if (!inc.dtheta_b_rad.allFinite() || !inc.dv_b_mps.allFinite() || !std::isfinite(inc.dt_s)) {
    return Verdict::kNotFinite;
  }
  if (!(inc.dt_s > 0.0) || inc.dt_s > config.max_jump_s ||
      inc.dtheta_b_rad.norm() > config.max_rate_radps * inc.dt_s ||
      inc.dv_b_mps.norm() > config.max_force_mps2 * inc.dt_s || !is_possible(inc.time)) {
    return Verdict::kImplausible;
  }
  return Verdict::kAccepted;
}

Verdict judge(const ImuSample& sample, const NavigatorConfig& config) {
  if (!sample.omega_ib_b_radps.allFinite() || !sample.f_ib_b_mps2.allFinite()) {
    return Verdict::kNotFinite;
  }
  if (sample.omega_ib_b_radps.norm() > config.max_rate_radps ||
      sample.f_ib_b_mps2.norm() > config.max_force_mps2 || !is_possible(sample.time)) {
    return Verdict::kImplausible;
  }
  return Verdict::kAccepted;
}

template <class R>
Verdict judge(const R& reading) {
  if (!all_finite(reading)) return Verdict::kNotFinite;
  return is_usable(reading) && is_possible(reading.time) ? Verdict::kAccepted
                                                         : Verdict::kImplausible;
}

const NavigatorConfig& checked(const NavigatorConfig& config) {
  validate(config);
  return config;
}

}  // namespace

void validate(const NavigatorConfig& config) {
  validate_fields("navigator", config);
  require("navigator", "max_jump_s", config.max_jump_s, between(config.max_gap_s, 1e5));
  if (config.C_bs && !((*config.C_bs * config.C_bs->transpose() - Eigen::Matrix3d::Identity())
                               .cwiseAbs()
                               .maxCoeff() < 1e-6 &&
                       config.C_bs->determinant() > 0.0)) {
    throw Error("navigator: C_bs must be a proper rotation to 1e-6");
  }
}

Navigator::Navigator(const NavigatorConfig& config)
    : config_(checked(config)),
      timeline_(config),
      clock_(config.max_jump_s, config.max_gap_s),
      receiver_clock_(config.filter.lever_arm_b_m) {}

void Navigator::start(const Estimate& estimate, const ErrorMatrix& P) {
  NavigatorState state(config_);
  state.start(estimate, P);
  timeline_.restart(state, estimate.nav.time);
  clock_.set(estimate.nav.time);
  sample_.reset();
}

std::uint64_t Navigator::count(Verdict verdict) const {
  const auto k = static_cast<std::size_t>(verdict);
  return counts_[k] + timeline_.ledger()[k];
}

Verdict Navigator::counted(Verdict verdict) {
  ++counts_[static_cast<std::size_t>(verdict)];
  return verdict;
}

Verdict Navigator::push(const ImuIncrement& inc) { return counted(take(inc)); }

Verdict Navigator::push(const ImuSample& sample) { return counted(take(sample)); }

Verdict Navigator::take(const ImuSample& sample) {
  if (const auto verdict = judge(sample, config_); verdict != Verdict::kAccepted) return verdict;
  ImuSample on_line = sample;
  on_line.time = clock_.counted_on(sample.time);
  const std::optional<ImuSample> before = sample_;
  if (before && on_line.time > before->time) {
    ImuIncrement inc = increment_between(*before, on_line, config_.rate_meaning);
    inc.time = sample.time;
    const Verdict verdict = take(inc);
    const bool doubted = verdict == Verdict::kFuture || verdict == Verdict::kOutOfOrder;
    if (!doubted) sample_ = on_line;
    return verdict;
  }
  if (before && on_line.time == before->time) return Verdict::kDuplicate;
  // The first sample only starts the clock, and so does one on another time line.
  const Verdict verdict = before ? clock_.judge(sample.time) : Verdict::kAligning;
  if (!before || verdict == Verdict::kClockJump) sample_ = on_line;
  return verdict;
}

Verdict Navigator::take(const ImuIncrement& inc) {
  if (const auto verdict = judge(inc, config_); verdict != Verdict::kAccepted) return verdict;
  const std::optional<Time> before = clock_.newest();
  const Verdict verdict = clock_.judge(inc.time);
  Step step{inc};
  step.inc.time = clock_.counted_on(inc.time);
  if (verdict == Verdict::kClockJump) timeline_.restart(NavigatorState(config_), step.inc.time);
  if (verdict == Verdict::kDuplicate) carry_over(inc);
  if (verdict != Verdict::kAccepted) return verdict;

  const double dt_s = before ? to_seconds(step.inc.time - *before) : inc.dt_s;
  add_carried(step.inc, dt_s);
  newest_ = inc;
  step.is_gap = std::max(dt_s, inc.dt_s) > config_.max_gap_s;
  if (dt_s != step.inc.dt_s) step.inc = stretched(step.inc, dt_s);
  timeline_.push(step);
  watch_clock(step);
  if (step.is_gap) return Verdict::kGap;
  return aligned() ? Verdict::kAccepted : Verdict::kAligning;
}

// An increment that differs from the one of its time is motion, with a stamp that is wrong: it
// belongs to the time until the next one. Rates that were lost cost little, and have no duration.
void Navigator::carry_over(const ImuIncrement& inc) {
  if (newest_ && newest_->dtheta_b_rad == inc.dtheta_b_rad && newest_->dv_b_mps == inc.dv_b_mps) {
    return;
  }
  ImuIncrement sum = inc;
  if (carried_) append(sum, *carried_);
  carried_ = sum;
}

/// @param dt_s  to the increment before
void Navigator::add_carried(ImuIncrement& inc, double dt_s) {
  if (!carried_) return;
  const double with_it_s = inc.dt_s + carried_->dt_s;
  if (std::abs(dt_s - with_it_s) < std::abs(dt_s - inc.dt_s)) {
    const Time end = inc.time;
    append(inc, *carried_);
    inc.time = end;
  }
  carried_.reset();
}

Verdict Navigator::push(const Reading& reading) {
  const auto verdict = std::visit([](const auto& r) { return judge(r); }, reading);
  if (verdict != Verdict::kAccepted) return counted(verdict);
  if (const auto* fix = std::get_if<GnssFix>(&reading)) return take(*fix);
  const Time t = std::visit([](const auto& r) { return r.time; }, reading);
  return take({clock_.counted_on(t), reading});
}

// Several filters are told apart by other things. The attitude of one is known.
void Navigator::watch_clock(const Step& step) {
  if (step.is_gap || !aligned() || !state().bank().collapsed()) return receiver_clock_.restart();
  ImuIncrement inc = step.inc;
  if (const auto& C_bs = state().C_bs()) {
    inc.dtheta_b_rad = *C_bs * inc.dtheta_b_rad;
    inc.dv_b_mps = *C_bs * inc.dv_b_mps;
  }
  receiver_clock_.push(inc, filter().estimate());
  if (!config_.timing.estimate_clock || !receiver_clock_.offset().age.beyond_chance) return;
  // The estimate has followed the fixes, old as they were.
  NavigatorState widened = state();
  widened.widen(receiver_clock_.covariance(filter().estimate()));
  timeline_.restart(widened, step.inc.time);
  receiver_clock_.take_out();
}

Verdict Navigator::take(const GnssFix& fix) {
  const FixAge lag_s = FixAge(config_.timing.position_lag_s, config_.timing.velocity_lag_s) +
                       receiver_clock_.taken_out_s();
  if (fix.heading) {
    const Time then = fix.time - duration_from_seconds(lag_s(0));
    push(MeasuredHeading{then, fix.heading->heading_rad, fix.heading->sigma_rad});
  }
  const Time t = clock_.counted_on(fix.time);
  GnssFix position = fix;
  position.heading.reset();
  GnssFix velocity = position;
  position.time = t - duration_from_seconds(lag_s(0));
  velocity.time = t - duration_from_seconds(lag_s(1));
  if (!fix.position) return take({velocity.time, velocity});
  if (!fix.velocity || position.time == velocity.time) return take({position.time, position});
  velocity.position.reset();
  position.velocity.reset();
  // The verdict is that on the position.
  take({velocity.time, velocity, false});
  return take({position.time, position});
}

Verdict Navigator::take(const Event& event) {
  if (const auto* fix = std::get_if<GnssFix>(&event.reading)) receiver_clock_.push(*fix);
  const std::optional<Time>& now = clock_.newest();
  if (now && to_seconds(event.time - *now) > config_.timing.max_ahead_s) {
    return event.counts ? counted(Verdict::kFuture) : Verdict::kFuture;
  }
  return timeline_.push(event);
}

Health Navigator::health() const {
  Health health = state().health(timeline_.now().value_or(Time{}));
  const ClockOffset& clock = receiver_clock_.offset();
  const FixAge& taken_out_s = receiver_clock_.taken_out_s();
  health.clock_offset_s = clock.age.value_s + taken_out_s(clock.of_velocity ? 1 : 0);
  health.clock_offset_sigma_s = clock.age.sigma_s;
  health.clock_offset_detected = clock.age.beyond_chance || receiver_clock_.is_taken_out();
  health.clock_offset_of_velocity =
      clock.of_velocity || (receiver_clock_.is_taken_out() && taken_out_s(0) == 0.0);
  if (health.state == Health::State::kAligned && clock.age.beyond_chance) {
    health.state = Health::State::kInconsistent;
  }
  return health;
}

TimeToLimit Navigator::leeway(double limit_m, double probability) const {
  if (!aligned()) return {};
  if (!receiver_clock_.offset().age.beyond_chance) {
    return time_to_limit(filter(), limit_m, probability);
  }
  Ekf widened = filter();
  edit(widened,
       [this](Belief& belief) { belief.P += receiver_clock_.covariance(belief.estimate); });
  return time_to_limit(widened, limit_m, probability);
}

Solution Navigator::solution() const {
  const Estimate& estimate = filter().estimate();
  return leeway::solution(estimate,
                          state().bank().covariance() + receiver_clock_.covariance(estimate));
}

}  // namespace leeway
