#include "leeway/navigator/heading_bank.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/gnss_measurement.hpp"

namespace leeway {
namespace {

// What each was chosen by: docs/theory/navigator/heading_bank.md.
constexpr double kSpacingRad = 18.0 * kRadPerDeg;  // wider where twelve members do not reach
constexpr double kEvidenceCorrelationS = 2.0;
constexpr double kIgnoredSurprise = 2.0;     // a difference of nis + log_det_S that decides nothing
constexpr double kMemory = 10.0;             // independent measurements
constexpr double kNegligibleVariance = 0.5;  // relative
constexpr int kFixDof = 3;
constexpr double kErrorEndsPerS = 0.1;       // of a receiver whose position or velocity is wrong
constexpr double kWholeErrorEndsPerS = 0.5;  // ... or both
constexpr double kLongAgoS = 1e3;

constexpr double kPi = 180.0 * kRadPerDeg;

/// The estimate with the vehicle turned about the antenna.
Estimate turned_about_antenna(const Estimate& estimate, const Eigen::Vector3d& turn_e_rad,
                              const Eigen::Vector3d& lever_arm_b_m) {
  Estimate result = estimate;
  result.nav.q_eb = (exp_quaternion(turn_e_rad) * estimate.nav.q_eb).normalized();
  result.nav.r_e_m +=
      antenna_position_e(estimate, lever_arm_b_m) - antenna_position_e(result, lever_arm_b_m);
  return result;
}

/// The covariance of attitude errors that are known in body axes, after the body has turned.
ErrorMatrix turned_with_body(ErrorMatrix P, const Eigen::Matrix3d& turn_e) {
  transform_block(P, kPsi, turn_e);
  P.block<3, 3>(kPsi, kPsi) =
      (0.5 * (P.block<3, 3>(kPsi, kPsi) + P.block<3, 3>(kPsi, kPsi).transpose())).eval();
  return P;
}

/// Whether the heavier one alone would tell of no variance of the two, about its own estimate, more
/// than kNegligibleVariance too little. With a probability near one half: it is the same estimate.
/// With a tiny one: it may be another.
/// @param probability  of the lighter of the two
bool is_negligible(const Ekf& lighter, const Ekf& heavier, double probability) {
  const ErrorVector x = difference(lighter.estimate(), heavier.estimate());
  const ErrorVector variance = heavier.covariance().diagonal();
  const ErrorVector added = x.cwiseAbs2() + lighter.covariance().diagonal() - variance;
  return (probability * added.array() <= kNegligibleVariance * variance.array()).all();
}

}  // namespace

HeadingBank::HeadingBank(const Ekf& filter) : count_(1) { members_[0].emplace(filter); }

HeadingBank::HeadingBank(const EkfConfig& config, const Estimate& estimate, const ErrorMatrix& P,
                         const Eigen::Vector3d& axis_e, double sigma_rad, double course_turns_s) {
  if (!(std::abs(axis_e.norm() - 1.0) < 1e-9)) {
    throw Error("heading bank: axis_e has norm " + std::to_string(axis_e.norm()) +
                ", must be 1 within 1e-9");
  }
  if (!(sigma_rad >= 0.0)) {
    throw Error("heading bank: sigma_rad is " + std::to_string(sigma_rad) + ", must be >= 0");
  }
  double member_sigma_rad = sigma_rad;
  double spacing_rad = 0.0;
  count_ = 1;
  if (sigma_rad > kOneFilterRad) {
    // Three sigmas to either side, or the circle.
    const double range_rad = std::min(6.0 * sigma_rad, 2.0 * kPi);
    count_ = static_cast<std::size_t>(
        std::min(std::ceil(range_rad / kSpacingRad), static_cast<double>(kMaxHeadings)));
    spacing_rad = range_rad / static_cast<double>(count_);
    member_sigma_rad = 0.5 * spacing_rad;
  }
  const bool equal_weights = count_ == 1 || sigma_rad >= kWholeCircleRad;
  // What the members' own variance leaves for their means, so that both together are sigma_rad^2.
  const double means_variance_rad2 = sigma_rad * sigma_rad - member_sigma_rad * member_sigma_rad;
  for (std::size_t k = 0; k < count_; ++k) {
    const double turn_rad =
        (static_cast<double>(k) - 0.5 * static_cast<double>(count_ - 1)) * spacing_rad;
    const Eigen::Vector3d turn_e_rad = turn_rad * axis_e;
    ErrorMatrix P_member = turned_with_body(P, exp_rotation(turn_e_rad));
    Estimate turned = turned_about_antenna(estimate, turn_e_rad, config.lever_arm_b_m);
    ErrorVector turn = ErrorVector::Zero();
    turn.segment<3>(kPsi) = member_sigma_rad * axis_e;
    if (course_turns_s > 0.0) {
      // At the end of the time the velocity is turned, on the way by half: the place is behind.
      const Eigen::Vector3d before_e_mps = estimate.nav.v_e_mps;
      turned.nav.v_e_mps = exp_rotation(turn_e_rad) * before_e_mps;
      turned.nav.r_e_m -= 0.5 * course_turns_s * (turned.nav.v_e_mps - before_e_mps);
      turn.segment<3>(kDv) = turn.segment<3>(kPsi).cross(turned.nav.v_e_mps);
      turn.segment<3>(kDr) = -0.5 * course_turns_s * turn.segment<3>(kDv);
    }
    P_member += turn * turn.transpose();
    members_[k].emplace(config, turned, P_member);
    log_weight_[k] = equal_weights ? 0.0 : -0.5 * turn_rad * turn_rad / means_variance_rad2;
  }
  normalize();
}

double HeadingBank::best_weight() const { return std::exp(log_weight_[best_]); }

void HeadingBank::weigh(const Outcomes& outcomes, bool of_heading) {
  using Outcome = UpdateOutcome::Outcome;
  const auto refused_before = refused_;
  for (std::size_t k = 0; k < kMaxFilters; ++k) {
    if (outcomes[k].dof >= kFixDof) refused_[k] = outcomes[k].outcome == Outcome::kGated;
  }
  const auto is_fused = [](const UpdateOutcome& r) { return r.outcome == Outcome::kFused; };
  const auto fused = std::find_if(outcomes.begin(), outcomes.end(), is_fused);
  if (fused == outcomes.end()) return;
  std::optional<Time>& last =
      last_evidence_[of_heading ? 0 : static_cast<std::size_t>(std::clamp(fused->dof, 1, 6))];
  const double since_s = last ? to_seconds(fused->time - *last) : kLongAgoS;
  last = fused->time;
  if (collapsed()) return;
  // p^weight: what a measurement tells beyond the one before it, by gnss_position_weight().
  const double root = gnss_position_weight(since_s, kEvidenceCorrelationS);
  const double weight = root * root;
  const bool are_rivals = incumbent_ && count_ <= kMaxRivals;
  std::array<double, kMaxFilters> surprise{};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < kMaxFilters; ++k) {
    if (!members_[k]) continue;
    const UpdateOutcome& r = outcomes[k];
    const bool refuses = r.outcome == Outcome::kGated;
    surprise[k] = (r.nis < r.gate ? r.nis : r.gate) + r.log_det_S;
    const bool broken = r.outcome == Outcome::kUnusable || !std::isfinite(surprise[k]);
    if (broken && !collapsed()) {
      drop(k);
      continue;
    }
    const bool is_refusing = are_rivals && k == *incumbent_ && refused_before[k];
    if (is_refusing && refuses) {
      log_weight_[k] -= (r.fused_in_part ? kErrorEndsPerS : kWholeErrorEndsPerS) * since_s;
      surprise[k] = std::numeric_limits<double>::lowest();
      continue;
    }
    if (!is_refusing) log_weight_[k] *= 1.0 - weight / kMemory;
    if (broken) surprise[k] = 0.0;  // the last one stays, whatever it is
    least = std::min(least, surprise[k]);
  }
  for (std::size_t k = 0; k < kMaxFilters; ++k) {
    log_weight_[k] -= 0.5 * weight * std::max(surprise[k] - least - kIgnoredSurprise, 0.0);
  }
  normalize();
  merge();
}

void HeadingBank::normalize() {
  double largest = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < kMaxFilters; ++k) {
    if (!members_[k] || !(log_weight_[k] > largest)) continue;
    largest = log_weight_[k];
    best_ = k;
  }
  double sum = 0.0;
  for (std::size_t k = 0; k < kMaxFilters; ++k) {
    if (members_[k]) sum += std::exp(log_weight_[k] - largest);
  }
  const double log_sum = largest + std::log(sum);
  for (std::size_t k = 0; k < kMaxFilters; ++k) log_weight_[k] -= log_sum;
}

void HeadingBank::merge() {
  for (std::size_t i = 0; i < kMaxFilters; ++i) {
    for (std::size_t j = i + 1; j < kMaxFilters; ++j) {
      if (!members_[i] || !members_[j]) continue;
      const bool i_heavier = log_weight_[i] >= log_weight_[j];
      const std::size_t heavy = i_heavier ? i : j;
      const std::size_t light = i_heavier ? j : i;
      const double ratio = std::exp(log_weight_[light] - log_weight_[heavy]);
      if (!is_negligible(*members_[light], *members_[heavy], ratio / (1.0 + ratio))) continue;
      log_weight_[heavy] += std::log1p(ratio);
      drop(light);
    }
  }
  normalize();
  join();
}

// Members that differ by little more than each is uncertain are one filter that is as uncertain as
// all of them, in their middle.
void HeadingBank::join() {
  constexpr double kLittleMore = 3.0;  // in variance
  if (collapsed()) return;
  const ErrorVector within = best().kernel().matrix().diagonal();
  if ((covariance().diagonal().array() > kLittleMore * within.array()).any()) return;
  ErrorVector middle = ErrorVector::Zero();
  ErrorMatrix between = ErrorMatrix::Zero();
  for (std::size_t k = 0; k < kMaxFilters; ++k) {
    if (!members_[k] || k == best_) continue;
    const ErrorVector x = difference(members_[k]->estimate(), best().estimate());
    const double weight = std::exp(log_weight_[k]);
    middle += weight * x;
    between += weight * x * x.transpose();
    drop(k);
  }
  edit(best(), [&](Belief& belief) {
    inject(belief.estimate, middle);
    belief.P += between - middle * middle.transpose();
  });
  normalize();
}

void HeadingBank::challenge(const Ekf& rival, double odds) {
  constexpr double kTrustedScale = 2.0;  // who doubts its own IMU has no standing
  if (!incumbent_ && best().inertial().noise_scale() < kTrustedScale) incumbent_ = best_;
  add(rival, odds, kMaxRivals);
}

void HeadingBank::add(const Ekf& rival, double odds, std::size_t max_count) {
  if (count_ >= max_count) drop(lightest_but_best());
  std::size_t free = 0;
  while (members_[free]) ++free;
  members_[free].emplace(rival);
  refused_[free] = false;
  log_weight_[free] = log_weight_[best_] + std::log(odds);
  ++count_;
  normalize();
}

const Ekf& HeadingBank::most_doubting() const {
  const Ekf* most = &best();
  for (const std::optional<Ekf>& member : members_) {
    if (member && member->inertial().noise_scale() > most->inertial().noise_scale()) {
      most = &*member;
    }
  }
  return *most;
}

/// @pre there are two.
std::size_t HeadingBank::lightest_but_best() const {
  std::size_t lightest = kMaxFilters;
  for (std::size_t k = 0; k < kMaxFilters; ++k) {
    if (!members_[k] || k == best_) continue;
    if (lightest == kMaxFilters || log_weight_[k] < log_weight_[lightest]) lightest = k;
  }
  return lightest;
}

void HeadingBank::drop(std::size_t k) {
  members_[k].reset();
  --count_;
  if (incumbent_ == k || collapsed()) incumbent_.reset();
}

ErrorMatrix HeadingBank::covariance() const {
  ErrorMatrix P = ErrorMatrix::Zero();
  for (std::size_t k = 0; k < kMaxFilters; ++k) {
    if (!members_[k]) continue;
    ErrorMatrix second_moment = members_[k]->covariance();
    if (k != best_) {
      const ErrorVector x = difference(members_[k]->estimate(), best().estimate());
      second_moment += x * x.transpose();
    }
    P += std::exp(log_weight_[k]) * second_moment;
  }
  return P;
}

}  // namespace leeway
