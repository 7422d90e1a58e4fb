#include "leeway/navigator/navigator.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/error.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway {
namespace {

constexpr Duration kFurthestTime = std::chrono::seconds{4'000'000'000};  // 127 years
constexpr double kCoastingS = 2.0;

bool all_finite(const GnssFix& fix) {
  return (!fix.position || (fix.position->r_e_m.allFinite() && fix.position->R_e_m2.allFinite())) &&
         (!fix.velocity ||
          (fix.velocity->v_e_mps.allFinite() && fix.velocity->R_e_m2ps2.allFinite()));
}

bool all_finite(const OdometerSpeed& odometer) {
  return std::isfinite(odometer.speed_mps) && std::isfinite(odometer.sigma_mps);
}

bool all_finite(const BarometricHeight& barometer) {
  return std::isfinite(barometer.height_m) && std::isfinite(barometer.sigma_m);
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

double seconds_since(const std::optional<Time>& then, const std::optional<Time>& now) {
  return then && now ? std::max(0.0, to_seconds(*now - *then)) : 0.0;
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
    : config_(config), history_(config), clock_(config.max_jump_s, config.max_gap_s) {}

void Navigator::start(const Estimate& estimate, const ErrorMatrix& P) {
  NavigatorState fusion(config_);
  fusion.start(estimate, P);
  history_.restart(fusion, estimate.nav.time);
  clock_.set(estimate.nav.time);
  sample_.reset();
}

std::uint64_t Navigator::count(Verdict verdict) const {
  const auto k = static_cast<std::size_t>(verdict);
  return counts_[k] + history_.ledger()[k];
}

Verdict Navigator::counted(Verdict verdict) {
  ++counts_[static_cast<std::size_t>(verdict)];
  return verdict;
}

Verdict Navigator::push(const ImuIncrement& inc) { return counted(take(inc, inc.time)); }

Verdict Navigator::push(const ImuSample& sample) {
  if (!sample.omega_ib_b_radps.allFinite() || !sample.f_ib_b_mps2.allFinite()) {
    return counted(Verdict::kNotFinite);
  }
  if (sample.omega_ib_b_radps.norm() > config_.max_rate_radps ||
      sample.f_ib_b_mps2.norm() > config_.max_force_mps2 || !is_possible(sample.time)) {
    return counted(Verdict::kImplausible);
  }
  ImuSample on_line = sample;
  on_line.time = clock_.counted_on(sample.time);
  const std::optional<ImuSample> before = sample_;
  if (before && on_line.time > before->time) {
    const ImuIncrement inc = increment_between(*before, on_line, config_.rate_meaning);
    const Verdict verdict = take(inc, sample.time);
    const bool doubted = verdict == Verdict::kFuture || verdict == Verdict::kOutOfOrder;
    if (!doubted) sample_ = on_line;
    return counted(verdict);
  }
  if (before && on_line.time == before->time) return counted(Verdict::kDuplicate);
  // The first sample only starts the clock, and so does one on another time line.
  const Verdict verdict = before ? clock_.judge(sample.time) : Verdict::kAligning;
  if (!before || verdict == Verdict::kClockJump) sample_ = on_line;
  return counted(verdict);
}

Verdict Navigator::judge(const ImuIncrement& inc) const {
  if (!inc.dtheta_b_rad.allFinite() || !inc.dv_b_mps.allFinite() || !std::isfinite(inc.dt_s)) {
    return Verdict::kNotFinite;
  }
  if (!(inc.dt_s > 0.0) || inc.dt_s > config_.max_jump_s ||
      inc.dtheta_b_rad.norm() > config_.max_rate_radps * inc.dt_s ||
      inc.dv_b_mps.norm() > config_.max_force_mps2 * inc.dt_s || !is_possible(inc.time)) {
    return Verdict::kImplausible;
  }
  return Verdict::kAccepted;
}

Verdict Navigator::take(const ImuIncrement& inc, Time as_told) {
  if (const Verdict verdict = judge(inc); verdict != Verdict::kAccepted) return verdict;
  const std::optional<Time> before = clock_.newest();
  const Verdict verdict = clock_.judge(as_told);
  Step step{inc};
  step.inc.time = clock_.counted_on(as_told);
  if (verdict == Verdict::kClockJump) history_.restart(NavigatorState(config_), step.inc.time);
  if (verdict != Verdict::kAccepted) return verdict;

  const double dt_s = before ? to_seconds(step.inc.time - *before) : inc.dt_s;
  step.is_gap = std::max(dt_s, inc.dt_s) > config_.max_gap_s;
  if (dt_s != inc.dt_s) step.inc = stretched(step.inc, dt_s);
  history_.push(step);
  if (step.is_gap) return Verdict::kGap;
  return aligned() ? Verdict::kAccepted : Verdict::kAligning;
}

template <class Reading>
Verdict Navigator::judge_and_take(const Reading& reading) {
  if (!all_finite(reading)) return counted(Verdict::kNotFinite);
  if (!is_usable(reading) || !is_possible(reading.time)) return counted(Verdict::kImplausible);
  return take(reading);
}

Verdict Navigator::push(const GnssFix& fix) { return judge_and_take(fix); }
Verdict Navigator::push(const OdometerSpeed& odometer) { return judge_and_take(odometer); }
Verdict Navigator::push(const BarometricHeight& barometer) { return judge_and_take(barometer); }

Verdict Navigator::take(const GnssFix& fix) {
  const TimingConfig& timing = config_.timing;
  const Time t = clock_.counted_on(fix.time);
  GnssFix position = fix;
  GnssFix velocity = fix;
  position.time = t - duration_from_seconds(timing.position_lag_s);
  velocity.time = t - duration_from_seconds(timing.velocity_lag_s);
  if (!fix.position) return place({velocity.time, velocity});
  if (!fix.velocity || position.time == velocity.time) return place({position.time, position});
  velocity.position.reset();
  position.velocity.reset();
  // The verdict is that on the position.
  place({velocity.time, velocity, false});
  return place({position.time, position});
}

Verdict Navigator::take(const OdometerSpeed& odometer) {
  return place({clock_.counted_on(odometer.time), odometer});
}

Verdict Navigator::take(const BarometricHeight& barometer) {
  return place({clock_.counted_on(barometer.time), barometer});
}

Verdict Navigator::place(const Event& event) {
  const std::optional<Time>& now = clock_.newest();
  if (now && to_seconds(event.time - *now) > config_.timing.max_ahead_s) {
    return event.counts ? counted(Verdict::kFuture) : Verdict::kFuture;
  }
  return history_.push(event);
}

Solution Navigator::solution() const {
  return leeway::solution(filter().estimate(), fusion().bank().covariance());
}

Health Navigator::health() const {
  const NavigatorState& f = fusion();
  Health health;
  health.mount_known = f.C_bs().has_value();
  health.at_rest = f.at_rest();
  health.repairs = f.repairs();
  health.resets = f.resets();
  health.realignments = f.realignments();
  if (!f.aligned()) return health;
  health.coasting_s = seconds_since(f.last_fused(), history_.now());
  health.gating_s = seconds_since(f.gated_since(), history_.now());
  health.position_nis_ratio = f.position_noise().nis_ratio();
  health.velocity_nis_ratio = f.velocity_noise().nis_ratio();
  health.position_sigma_scale = f.position_noise().sigma_scale();
  health.velocity_sigma_scale = f.velocity_noise().sigma_scale();
  health.correlated_fixes =
      config_.filter.gnss_correlation_s == 0.0 && f.position_noise().errors_last();
  const double ratio = std::max(health.position_nis_ratio, health.velocity_nis_ratio);
  health.optimistic_by = std::sqrt(std::max(1.0, ratio));
  const bool is_inconsistent = f.distrusts_imu() || f.position_noise().is_inconsistent() ||
                               f.velocity_noise().is_inconsistent();
  using State = Health::State;
  health.state = f.gated_since()                  ? State::kGating
                 : health.coasting_s > kCoastingS ? State::kCoasting
                 : !f.bank().collapsed()          ? State::kHeadingOpen
                 : is_inconsistent                ? State::kInconsistent
                                                  : State::kAligned;
  return health;
}

}  // namespace leeway
