#include <algorithm>
#include <cmath>

#include "filters/navigator/heading_spread.hpp"
#include "leeway/navigator/navigator_state.hpp"

namespace leeway {
namespace {

constexpr double kOpenRad = 20.0 * kRadPerDeg;  // of heading: one linearized filter is not enough

bool has_white_error(const GnssFix& fix) {
  return fix.position && leeway::has_white_error(fix.position->R_e_m2.trace());
}

}  // namespace

Verdict NavigatorState::take(const GnssFix& fix) {
  switch (screen_.judge(fix, moves())) {
    case FixScreen::Finding::kNone:
      return Verdict::kImplausible;
    case FixScreen::Finding::kRepeated:
      return Verdict::kRepeated;
    case FixScreen::Finding::kNews:
      break;
  }
  return use(screen_.with_floor(fix));
}

Verdict NavigatorState::use(const GnssFix& fix) {
  if (!bank_) {
    align(fix);
    return Verdict::kAligning;
  }
  end_hole();
  if (heading_sigma_rad(bank_->best()) > kOpenRad) open_heading();
  const bool was_refused = gate_recovery_.is_row();
  if (!was_refused) incumbent_ = bank_->best_index();
  const double fix_interval_s = to_seconds(fix.time - last_fused_.value_or(fix.time));
  bool is_explained = false;  // by any of the filters
  last_update_ = bank_->update([&](Ekf& filter) {
    const UpdateOutcome outcome = update(filter, fix);
    is_explained = is_explained || outcome.outcome == UpdateOutcome::Outcome::kFused;
    return outcome;
  });
  Verdict verdict = settle(fix, is_explained);
  if (was_refused && verdict == Verdict::kFused && incumbent_ != bank_->best_index()) {
    ++resets_;
    contradicted_ = fix.time;
    gate_recovery_.begin(fix.time);
    position_noise_.begin_claims();
    velocity_noise_.begin_claims();
    verdict = Verdict::kReset;
  }
  if (!is_sane(*bank_)) {
    realign();
    return Verdict::kReset;
  }
  bank_->for_each([this](Ekf& filter) {
    if (!repair_covariance(filter)) ++repairs_;
  });
  if (!C_bs_) find_mount();
  watch_course(fix);
  start_beside(fix, fix_interval_s);
  watch_coasting();
  return verdict;
}

void NavigatorState::watch_course(const GnssFix& fix) {
  const bool tells =
      limits_of(config_.vehicle.kind).goes_where_it_points && C_bs_ && bank_->collapsed();
  if (!tells || !fix.velocity || last_update_.outcome != UpdateOutcome::Outcome::kFused) return;
  if (!course_.push(fix, bank_->best())) return;
  contradicted_ = fix.time;
  doubt_heading(bank_->best(), bank_->best());
}

// At rest an IMU is quieter than on the road. One that is taken for noisier than it was shown to be
// is in doubt just now.
void NavigatorState::watch_coasting() {
  constexpr double kInDoubt = 1.5;
  const bool is_sound =
      bank_->collapsed() && !gate_recovery_.is_row() && !aiding_.at_rest() &&
      bank_->best().inertial().noise_scale() < kInDoubt * std::max(1.0, coast_.imu_sigma_scale());
  if (!is_sound) return coast_.restart();
  if (!coast_.compare(bank_->best())) return;
  contradicted_ = bank_->best().estimate().nav.time;
  doubt_heading(bank_->best(), bank_->best());
}

bool NavigatorState::was_opened(Time now) const {
  constexpr double kOnceInS = 60.0;
  return heading_doubted_ && to_seconds(now - *heading_doubted_) < kOnceInS;
}

UpdateOutcome NavigatorState::update(Ekf& filter, const GnssFix& fix) const {
  const bool hides = motion_hides_heading(fix.time) && rest_hides_heading(filter);
  const FixTrust trust{position_noise_.sigma_scale(), velocity_noise_.sigma_scale(),
                       hides ? Held::kHeadingAndTurn : Held::kNothing, has_white_error(fix)};
  UpdateOutcome outcome = filter.update(fix, trust);
  if (outcome.outcome != UpdateOutcome::Outcome::kGated || !fix.position || !fix.velocity) {
    return outcome;
  }
  GnssFix part = fix;
  const ErrorMatrix& P = filter.kernel().matrix();
  const bool by_velocity = outcome.position_nis > outcome.velocity_nis;
  by_velocity ? part.position.reset() : part.velocity.reset();
  // A part that agrees with whatever it is compared with proves nothing.
  constexpr double kKnown = 10.0;  // variance of the filter, times the receiver's
  const bool is_known =
      by_velocity ? P.block<3, 3>(kDv, kDv).trace() < kKnown * part.velocity->R_e_m2ps2.trace()
                  : P.block<3, 3>(kDr, kDr).trace() < kKnown * part.position->R_e_m2.trace();
  if (!is_known) return outcome;
  outcome.fused_in_part = filter.update(part, trust).outcome == UpdateOutcome::Outcome::kFused;
  return outcome;
}

Verdict NavigatorState::settle(const GnssFix& fix, bool is_explained) {
  using Outcome = UpdateOutcome::Outcome;
  if (last_update_.outcome == Outcome::kUnusable) return Verdict::kImplausible;
  const bool is_gated = last_update_.outcome == Outcome::kGated;
  // A fix that is refused alone, or that cannot be true, is an outlier: it says nothing of the
  // noise of the others, and its distance is not one that the estimate has drifted.
  const bool was_row = gate_recovery_.is_row();
  const double odds =
      is_gated ? gate_recovery_.odds_of(fix, refuses_position_alone(last_update_)) : 0.0;
  const bool is_outlier = is_gated && (!was_row || odds == 0.0);
  const bool differ_in_heading = bank_->count() > HeadingBank::kMaxRivals;
  if (differ_in_heading) {
    if (fix.velocity) velocity_noise_.note_claim(last_update_.velocity_nis);
    if (fix.position) position_noise_.note_claim(last_update_.position_nis);
  } else if (!is_outlier) {
    learn_noise(fix);
  }
  if (is_gated) {
    if (odds > 0.0 && !is_explained) challenge(fix, odds);
    if (!last_update_.fused_in_part) return Verdict::kGated;
    last_fused_ = fix.time;
    return Verdict::kPartly;
  }
  learn_imu_noise(fix);
  last_fused_ = fix.time;
  gate_recovery_.fused(fix, bank_->best());
  return Verdict::kFused;
}

bool NavigatorState::is_white(const GnssFix& fix) const {
  return config_.filter.gnss_correlation_s == 0.0 || has_white_error(fix);
}

void NavigatorState::learn_noise(const GnssFix& fix) {
  const UpdateOutcome& u = last_update_;
  bool is_surprising = false;
  const auto note = [&](ReceiverNoise& noise, const auto& innovation, const auto& R, double nis,
                        bool is_white) {
    noise.note(fix.time, innovation, R, nis, is_white);
    is_surprising = is_surprising || noise.is_surprising();
  };
  if (fix.velocity) {
    note(velocity_noise_, u.velocity_innovation_e_mps, fix.velocity->R_e_m2ps2, u.velocity_nis,
         true);
  }
  if (fix.position) {
    note(position_noise_, u.position_innovation_e_m, fix.position->R_e_m2, u.position_nis,
         is_white(fix));
  }
  if (is_surprising) contradicted_ = fix.time;
  // Positions that keep away from the prediction by more than both claim, and agree with each
  // other, are believed at last: a receiver that settles, or one that was wrong before.
  constexpr double kDriftRatio = 2.0;  // of NIS to its expectation, over 30 fixes
  constexpr double kShare = 0.1;       // of the squared distance, at each fix
  if (!position_noise_.has_full_window() || position_noise_.nis_ratio() < kDriftRatio) return;
  const double variance_m2 = kShare / 3.0 * u.position_innovation_e_m.squaredNorm();
  edit(bank_->best(),
       [&](Belief& belief) { belief.P.diagonal().segment<3>(kDr).array() += variance_m2; });
}

// What neither the receiver's noise nor chance explains is the IMU's. Fast up, slow down: to claim
// too little for a minute costs less than to claim too much.
void NavigatorState::learn_imu_noise(const GnssFix& fix) {
  constexpr double kUpS = 30.0;
  constexpr double kDownS = 300.0;  // times the squared ratio: what is far too wide is plain
  constexpr double kShortestDownS = 10.0;
  constexpr double kBeyondChance = 2.0;  // 30 degrees of freedom stay below with 99.9 %
  constexpr double kSteepestRatio = 4.0;
  const double dt_s = std::clamp(to_seconds(fix.time - last_fused_.value_or(fix.time)), 0.0, kUpS);
  // A slow error of the receiver's positions would be taken for the IMU's.
  const double position_ratio = is_white(fix) ? position_noise_.recent_nis_ratio() : 0.0;
  const double ratio = std::max(position_ratio, velocity_noise_.recent_nis_ratio());
  const double down_s = std::max(kShortestDownS, kDownS * ratio * ratio);
  const double up = std::pow(std::min(ratio, kSteepestRatio), dt_s / kUpS);
  const double shown = coast_.imu_sigma_scale();
  bank_->for_each([&](Ekf& filter) {
    double scale = filter.inertial().noise_scale();
    if (ratio > kBeyondChance && bank_->count() <= HeadingBank::kMaxRivals) scale *= up;
    if (ratio < 1.0) scale = shown + (scale - shown) * std::exp(-dt_s / down_s);
    filter.scale_imu_noise(std::clamp(scale, shown, kLargestImuScale));
  });
}

void NavigatorState::challenge(const GnssFix& fix, double odds) {
  constexpr double kLeastUnseenMps = 1.0;
  constexpr double kMostUnseenMps = 30.0;
  const double gained_mps = limits_of(config_.vehicle.kind).acceleration_mps2 *
                            to_seconds(fix.time - last_fused_.value_or(fix.time));
  const double unseen_mps = std::clamp(gained_mps, kLeastUnseenMps, kMostUnseenMps);
  const auto rival = [&](const Ekf& filter) {
    return rival_of(filter, fix, last_update_, unseen_mps);
  };
  // Where a part was fused the filter is near: nothing else is in doubt for a while.
  const bool is_part = last_update_.fused_in_part && odds < 1.0;
  const Ekf& doubting = is_part ? bank_->best() : bank_->most_doubting();
  const double scale = doubting.inertial().noise_scale();
  const bool is_repeated = gate_recovery_.is_repeated() && !is_part;
  if (is_repeated && !refuses_position_alone(last_update_) &&
      doubt_heading(rival(bank_->best()), rival(doubting))) {
    return;
  }
  if (bank_->count() > HeadingBank::kMaxRivals) {
    if (is_repeated) bank_->for_each([&](Ekf& filter) { filter = rival(filter); });
    return;
  }
  // The more its IMU is doubted already, the likelier the filter is what is wrong.
  bank_->challenge(rival(doubting), scale * scale * odds);
}

// Fixes that agree with each other and with no filter: it is the heading, or the IMU.
bool NavigatorState::doubt_heading(Ekf around, const Ekf& doubting) {
  const Time now = around.estimate().nav.time;
  if (was_opened(now)) return false;
  around.scale_imu_noise(bank_->best().inertial().noise_scale());
  auto headings = bank_of_headings(around, HeadingBank::kWholeCircleRad);
  if (!headings) return false;
  headings->add(doubting, 1.0);
  if (&doubting != &bank_->best()) headings->add(bank_->best(), 1.0);
  bank_ = *headings;
  heading_doubted_ = now;
  return true;
}

}  // namespace leeway
