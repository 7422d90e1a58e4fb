#include "leeway/navigator/navigator_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "filters/navigator/heading_spread.hpp"
#include "leeway/model/heading.hpp"

namespace leeway {
namespace {

constexpr double kOpenRad = 20.0 * kRadPerDeg;  // of heading: one linearized filter is not enough

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

/// Carrier phase with fixed ambiguities: what is left is noise and multipath of centimetres, which
/// changes with every few metres. Errors of code last for half a minute.
bool has_white_error(const GnssFix& fix) {
  constexpr double kFixedM = 0.05;  // a quarter of the carrier's wavelength
  return fix.position && fix.position->R_e_m2.trace() < 3.0 * kFixedM * kFixedM;
}

bool is_sane(HeadingBank& bank) {
  bool all = true;
  bank.for_each([&](const Ekf& filter) {
    all = all && leeway::is_sane(filter.estimate(), filter.kernel().matrix());
  });
  return all;
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
  if (imu_screen_.is_held(inc) && moves()) {
    contradicted_ = inc.time;
    return bridge(inc.time);
  }
  end_hole();
  if (is_starting_beside_) aligner_.push(in_body);
  bank_->for_each([&](Ekf& filter) { filter.predict(in_body); });
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

// At constant velocity as at rest the specific force is along gravity: neither heading nor the
// gyro's bias about the vertical shows. What a turn has shown takes a few fixes to be read.
bool NavigatorState::motion_hides_heading(Time t) const {
  if (aiding_.at_rest()) return true;
  constexpr double kReadS = 10.0;
  constexpr double kReadFixes = 3.0;
  const double fix_interval_s = to_seconds(t - last_fused_.value_or(t));
  return !config_.vehicle.non_holonomic &&
         aiding_.even_motion_s() > std::max(kReadS, kReadFixes * fix_interval_s);
}

bool NavigatorState::moves() const {
  constexpr double kMovingMps = 0.5;
  if (!bank_) return false;
  const Ekf& filter = bank_->best();
  const double sigma_mps = std::sqrt(filter.kernel().matrix().diagonal().segment<3>(kDv).sum());
  return filter.estimate().nav.v_e_mps.norm() > kMovingMps + 3.0 * sigma_mps;
}

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
  start_beside(fix);
  return verdict;
}

// The IMU may be right again, or it was the attitude that was wrong: where the IMU is taken for a
// far noisier one than it is, a second start is weighed against the filter.
void NavigatorState::start_beside(const GnssFix& fix) {
  constexpr double kDoubtedScale = 4.0;
  const Ekf filter = bank_->best();
  if (!bank_->collapsed() || filter.inertial().noise_scale() < kDoubtedScale ||
      was_opened(fix.time)) {
    is_starting_beside_ = false;
    return;
  }
  if (!is_starting_beside_) aligner_ = aligner_of(config_);
  is_starting_beside_ = true;
  const auto found = aligner_.push(fix);
  if (!found || !can_start(found->estimate, found->P)) return;
  bank_ = HeadingBank(filter.inertial().config(), found->estimate, found->P, found->axis_e,
                      found->turn_sigma_rad);
  if (C_bs_) begin_vehicle();
  // As likely as all of the others together, and the best until they explain the fixes better.
  bank_->challenge(filter, HeadingBank::kMaxHeadings, HeadingBank::kMaxFilters);
  heading_doubted_ = fix.time;
  is_starting_beside_ = false;
}

void NavigatorState::watch_course(const GnssFix& fix) {
  const bool tells = limits_of(config_.vehicle.kind).goes_where_it_points && C_bs_ &&
                     bank_->collapsed();
  if (!tells || !fix.velocity || last_update_.outcome != UpdateOutcome::Outcome::kFused) return;
  if (!course_.push(fix, bank_->best())) return;
  contradicted_ = fix.time;
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
  if (outcome.position_nis > outcome.velocity_nis) {
    part.position.reset();
  } else {
    part.velocity.reset();
  }
  outcome.fused_in_part = filter.update(part, trust).outcome == UpdateOutcome::Outcome::kFused;
  return outcome;
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
  bank_->challenge(Ekf(filter_of(config_), backing, found->P), kBackingOdds);
}

Verdict NavigatorState::settle(const GnssFix& fix, bool is_explained) {
  using Outcome = UpdateOutcome::Outcome;
  if (last_update_.outcome == Outcome::kUnusable) return Verdict::kImplausible;
  const bool is_gated = last_update_.outcome == Outcome::kGated;
  // A fix that is refused alone, or that cannot be true, is an outlier: it says nothing of the
  // noise of the others, and its distance is not one that the estimate has drifted.
  const bool was_row = gate_recovery_.is_row();
  const double odds = is_gated ? gate_recovery_.odds_of(fix) : 0.0;
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
  const double position_ratio =
      is_white(fix)
          ? position_noise_.recent_nis_ratio()
          : 0.0;
  const double ratio = std::max(position_ratio, velocity_noise_.recent_nis_ratio());
  const double down_s = std::max(kShortestDownS, kDownS * ratio * ratio);
  const double up = std::pow(std::min(ratio, kSteepestRatio), dt_s / kUpS);
  bank_->for_each([&](Ekf& filter) {
    double scale = filter.inertial().noise_scale();
    if (ratio > kBeyondChance && bank_->count() <= HeadingBank::kMaxRivals) scale *= up;
    if (ratio < 1.0) scale = 1.0 + (scale - 1.0) * std::exp(-dt_s / down_s);
    filter.scale_imu_noise(std::min(scale, kLargestImuScale));
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
  // Where a part was fused the filter is near: nothing else is in doubt for now.
  const bool is_part = last_update_.fused_in_part;
  const Ekf& doubting = is_part ? bank_->best() : bank_->most_doubting();
  const double scale = doubting.inertial().noise_scale();
  const bool is_repeated = gate_recovery_.is_repeated() && !is_part;
  if (is_repeated && doubt_heading(rival(bank_->best()), rival(doubting))) return;
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
  headings->challenge(doubting, 1.0, HeadingBank::kMaxFilters);
  if (&doubting != &bank_->best()) headings->challenge(bank_->best(), 1.0, HeadingBank::kMaxFilters);
  bank_ = *headings;
  heading_doubted_ = now;
  return true;
}

void NavigatorState::realign() {
  ++realignments_;
  contradicted_ = bank_->best().estimate().nav.time;
  bank_.reset();
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
  begin_vehicle();
}

}  // namespace leeway
