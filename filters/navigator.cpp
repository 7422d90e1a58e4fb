#include "leeway/filters/navigator.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "leeway/error.hpp"

namespace leeway {
namespace {

constexpr std::array<std::string_view, kVerdicts> kVerdictNames{
    "accepted",  "aligning",     "fused",      "gated",       "gap",     "late",
    "duplicate", "out_of_order", "not_finite", "implausible", "overflow"};

bool all_finite(const GnssFix& fix) {
  return (!fix.position || (fix.position->r_e_m.allFinite() && fix.position->R_e_m2.allFinite())) &&
         (!fix.velocity ||
          (fix.velocity->v_e_mps.allFinite() && fix.velocity->R_e_m2ps2.allFinite()));
}

/// The increment over a longer interval at the same mean rates: bridges a short hole.
ImuIncrement stretched(const ImuIncrement& inc, double dt_s) {
  ImuIncrement result = inc;
  result.dt_s = dt_s;
  result.dtheta_b_rad *= dt_s / inc.dt_s;
  result.dv_b_mps *= dt_s / inc.dt_s;
  return result;
}

}  // namespace

std::string_view name(Verdict verdict) { return kVerdictNames[static_cast<std::size_t>(verdict)]; }

Navigator::Navigator(const NavigatorConfig& config)
    : config_(config), aligner_(config.alignment, config.filter) {
  if (!(config.max_gap_s > 0.0 && config.max_rate_radps > 0.0 && config.max_force_mps2 > 0.0)) {
    throw Error("navigator: max_gap_s, max_rate_radps and max_force_mps2 must be > 0");
  }
  // A bad filter configuration is to be told now, not when alignment ends in the middle of a drive.
  Estimate somewhere;
  somewhere.nav.r_e_m.x() = wgs84::kSemiMajorAxisM;
  Ekf(config.filter, somewhere, ErrorMatrix::Identity());
}

void Navigator::start(const Estimate& estimate, const ErrorMatrix& P) {
  filter_ = Ekf(config_.filter, estimate, P);
  imu_time_ = estimate.nav.time;
  while (waiting_count_ > 0 && waiting_[0].time < *imu_time_) {
    take_waiting();
    counted(Verdict::kLate);
  }
}

Verdict Navigator::counted(Verdict verdict) {
  ++counts_[static_cast<std::size_t>(verdict)];
  return verdict;
}

Verdict Navigator::push(const ImuIncrement& inc) { return counted(take(inc)); }

Verdict Navigator::take(const ImuIncrement& inc) {
  if (!inc.dtheta_b_rad.allFinite() || !inc.dv_b_mps.allFinite() || !std::isfinite(inc.dt_s)) {
    return Verdict::kNotFinite;
  }
  if (!(inc.dt_s > 0.0) || inc.dtheta_b_rad.norm() > config_.max_rate_radps * inc.dt_s ||
      inc.dv_b_mps.norm() > config_.max_force_mps2 * inc.dt_s) {
    return Verdict::kImplausible;
  }
  if (imu_time_ && inc.time == *imu_time_) return Verdict::kDuplicate;
  if (imu_time_ && inc.time < *imu_time_) return Verdict::kOutOfOrder;
  const double dt_s = imu_time_ ? to_seconds(inc.time - *imu_time_) : inc.dt_s;
  const bool gap = std::max(dt_s, inc.dt_s) > config_.max_gap_s;
  if (gap && !filter_) {
    // What was collected before a hole says nothing about the attitude after it.
    aligner_ = Aligner(config_.alignment, config_.filter);
    imu_time_ = inc.time;
    return Verdict::kGap;
  }
  if (gap) {
    while (waiting_count_ > 0 && waiting_[0].time <= inc.time) {
      if (waiting_[0].time > *imu_time_) filter_->coast(waiting_[0].time);
      apply(take_waiting());
    }
    if (filter_->estimate().nav.time < inc.time) filter_->coast(inc.time);
    imu_time_ = inc.time;
    return Verdict::kGap;
  }
  advance(dt_s == inc.dt_s ? inc : stretched(inc, dt_s));
  imu_time_ = inc.time;
  return filter_ ? Verdict::kAccepted : Verdict::kAligning;
}

void Navigator::advance(const ImuIncrement& inc) {
  ImuIncrement rest = inc;
  const auto integrate = [this](const ImuIncrement& piece) {
    filter_ ? filter_->predict(piece) : aligner_.push(piece);
  };
  while (waiting_count_ > 0 && waiting_[0].time <= inc.time) {
    const GnssFix fix = take_waiting();
    const Time begin = rest.time - duration_from_seconds(rest.dt_s);
    if (fix.time == rest.time) {
      integrate(rest);
      rest.dt_s = 0.0;
    } else if (fix.time > begin) {
      const auto [before, after] = split(rest, fix.time);
      integrate(before);
      rest = after;
    }
    apply(fix);
  }
  if (rest.dt_s > 0.0) integrate(rest);
}

GnssFix Navigator::take_waiting() {
  const GnssFix fix = waiting_[0];
  std::copy(waiting_.begin() + 1, waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_count_),
            waiting_.begin());
  --waiting_count_;
  return fix;
}

void Navigator::apply(const GnssFix& fix) {
  if (!filter_) {
    if (const auto alignment = aligner_.push(fix)) {
      filter_.emplace(config_.filter, alignment->estimate, alignment->P);
    }
    counted(Verdict::kAligning);
    return;
  }
  last_update_ = filter_->update(fix);
  counted(last_update_.outcome == UpdateReport::Outcome::kFused   ? Verdict::kFused
          : last_update_.outcome == UpdateReport::Outcome::kGated ? Verdict::kGated
                                                                  : Verdict::kImplausible);
}

Verdict Navigator::push(const GnssFix& fix) {
  if (!all_finite(fix)) return counted(Verdict::kNotFinite);
  if (!is_usable(fix)) return counted(Verdict::kImplausible);
  if (fix_time_ && fix.time == *fix_time_) return counted(Verdict::kDuplicate);
  if (fix_time_ && fix.time < *fix_time_) return counted(Verdict::kOutOfOrder);
  if (imu_time_ && fix.time < *imu_time_) return counted(Verdict::kLate);
  if (waiting_count_ == kMaxWaiting) return counted(Verdict::kOverflow);
  fix_time_ = fix.time;
  waiting_[waiting_count_++] = fix;
  return Verdict::kAccepted;
}

Solution Navigator::solution() const {
  return leeway::solution(filter_->estimate(), filter_->covariance());
}

}  // namespace leeway
