#include "sim/inspect/shared_turns.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/units.hpp"

namespace leeway::sim {
namespace {

constexpr double kLevelS = 20.0;  ///< memory of the vertical: longer than a turn
constexpr double kLeastPairS = 0.9;
constexpr double kLongestPairS = 5.0;
constexpr double kLeastSpeedMps = 3.0;
constexpr double kLeastCourseSigmaRad = 0.5 * kRadPerDeg;
constexpr double kMostCourseSigmaRad = 0.2;
constexpr double kMostTurnRad = 2.0;  ///< of a pair: more is a reversal
constexpr double kBreakS = 1.0;       ///< without increments: what was before is forgotten
constexpr std::int64_t kFewPairs = 15;
constexpr double kBelievedSigmas = 4.0;  ///< of an offset that is still believed
/// Antennas sit at most so far ahead of the rear axle, more or less; a lorry's too.
constexpr double kLeadSigmaM = 3.0;
constexpr double kSingular = 1e-6;  ///< speeds and turns that tell too little apart

/// How many steps from the best offset others fit almost as well: minima beside it count.
template <class Residuals>
std::size_t reach(const Residuals& residuals, std::size_t best, double more) {
  std::size_t steps = 0;
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    if (residuals[k] - residuals[best] < more)
      steps = std::max(steps, k > best ? k - best : best - k);
  }
  return steps;
}

}  // namespace

void SharedTurns::add(const ImuIncrement& inc) {
  const Time begin = inc.time - duration_from_seconds(inc.dt_s);
  if (!last_time_ || to_seconds(begin - *last_time_) > kBreakS || inc.dt_s > kBreakS) {
    history_.clear();
    pairs_.clear();
  }
  last_time_ = inc.time;
  if (inc.dt_s > kBreakS) return;
  levelled_s_ = std::min(levelled_s_ + inc.dt_s, kLevelS);
  down_b_ -= (inc.dv_b_mps + inc.dt_s * down_b_) / levelled_s_;
  const double turn_rad = inc.dtheta_b_rad.dot(down_b_) / std::max(down_b_.norm(), 1e-9);
  if (history_.empty()) first_step_ = begin.time_since_epoch() / kStep + 1;
  // In whole nanoseconds, and one after the other whatever dt_s says, that no step is lost.
  for (auto step = first_step_ + static_cast<std::int64_t>(history_.size());
       step * kStep <= inc.time.time_since_epoch(); ++step) {
    const double to_end_s = to_seconds(inc.time.time_since_epoch() - step * kStep);
    const double share = std::clamp(1.0 - to_end_s / inc.dt_s, 0.0, 1.0);
    history_.push_back({now_.turn_rad + share * turn_rad, now_.dv_b_mps + share * inc.dv_b_mps});
  }
  now_.turn_rad += turn_rad;
  now_.dv_b_mps += inc.dv_b_mps;
  judge_pairs();
}

std::optional<SharedTurns::Course> SharedTurns::course_of(const GnssFix& fix) const {
  if (!fix.position) return std::nullopt;
  const Eigen::Matrix3d C_ne = ned_to_ecef(geodetic_from_ecef(fix.position->r_e_m)).transpose();
  const auto course = [&](Time time, const Eigen::Vector3d& v_e_mps, double sigma_mps) {
    const Eigen::Vector3d v_n_mps = C_ne * v_e_mps;
    const double speed_mps = v_n_mps.head<2>().norm();
    return Course{time, std::atan2(v_n_mps.y(), v_n_mps.x()), speed_mps,
                  std::max(sigma_mps / std::max(speed_mps, 1e-3), kLeastCourseSigmaRad)};
  };
  if (fix.velocity) {
    return course(fix.time, fix.velocity->v_e_mps, std::sqrt(fix.velocity->R_e_m2ps2.trace() / 3));
  }
  if (!last_fix_ || !last_fix_->position) return std::nullopt;
  const Duration step = fix.time - last_fix_->time;
  if (step.count() <= 0 || to_seconds(step) > kLongestPairS) return std::nullopt;
  const double sigma_m =
      std::sqrt((fix.position->R_e_m2.trace() + last_fix_->position->R_e_m2.trace()) / 3.0);
  return course(last_fix_->time + step / 2,
                (fix.position->r_e_m - last_fix_->position->r_e_m) / to_seconds(step),
                sigma_m / to_seconds(step));
}

void SharedTurns::add(const GnssFix& fix) {
  const std::optional<Course> course = course_of(fix);
  last_fix_ = fix;
  const bool is_usable =
      course && course->speed_mps >= kLeastSpeedMps && course->sigma_rad <= kMostCourseSigmaRad;
  if (!is_usable) {
    last_.reset();
    return;
  }
  if (!last_) {
    last_ = course;
    return;
  }
  const double step_s = to_seconds(course->time - last_->time);
  if (step_s < kLeastPairS) return;
  if (newest_) judge_gain(*newest_);
  newest_.reset();
  if (step_s <= kLongestPairS) {
    newest_ = Pair{*last_, *course};
    pairs_.push_back(*newest_);
  }
  last_ = course;
}

void SharedTurns::judge_pairs() {
  const Duration reach = duration_from_seconds((kMostSteps + 4) * kStepS);
  while (!pairs_.empty() && pairs_.front().to.time + reach <= *last_time_) {
    judge(pairs_.front());
    pairs_.pop_front();
  }
  const auto kept =
      static_cast<std::size_t>(2.0 * to_seconds(reach) / kStepS + 2.0 * kLongestPairS / kStepS);
  for (; history_.size() > kept; history_.pop_front()) ++first_step_;
}

std::optional<SharedTurns::Past> SharedTurns::at(Time t) const {
  const double place = to_seconds(t.time_since_epoch() - first_step_ * kStep) / kStepS;
  if (!(place >= 0.0) || place + 1.0 >= static_cast<double>(history_.size())) return std::nullopt;
  const auto k = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(k);
  const Past& a = history_[k];
  const Past& b = history_[k + 1];
  return Past{a.turn_rad + share * (b.turn_rad - a.turn_rad),
              a.dv_b_mps + share * (b.dv_b_mps - a.dv_b_mps)};
}

std::optional<SharedTurns::Turns> SharedTurns::turns_around(Time t) const {
  // Offsets are whole steps of the history: all fall at the same share between two of its entries.
  const double place =
      to_seconds(t.time_since_epoch() - first_step_ * kStep) / kStepS - (kMostSteps + kRateSteps);
  if (!(place >= 0.0) || place + kTurns + 1.0 > static_cast<double>(history_.size())) {
    return std::nullopt;
  }
  const auto first = static_cast<std::size_t>(place);
  const double share = place - static_cast<double>(first);
  Turns turns_rad{};
  auto past = history_.begin() + static_cast<std::ptrdiff_t>(first);
  double before_rad = past->turn_rad;
  for (double& turn_rad : turns_rad) {
    const double after_rad = (++past)->turn_rad;
    turn_rad = before_rad + share * (after_rad - before_rad);
    before_rad = after_rad;
  }
  return turns_rad;
}

void SharedTurns::judge(const Pair& pair) {
  const double y = std::remainder(pair.to.angle_rad - pair.from.angle_rad, 2.0 * std::numbers::pi);
  const std::optional<Turns> from_rad = turns_around(pair.from.time);
  const std::optional<Turns> to_rad = turns_around(pair.to.time);
  if (!from_rad || !to_rad || std::abs(y) > kMostTurnRad) return;
  const double w =
      1.0 / (pair.from.sigma_rad * pair.from.sigma_rad + pair.to.sigma_rad * pair.to.sigma_rad);
  constexpr double kRateS = 2.0 * kRateSteps * kStepS;
  const auto over_speed = [](const Turns& turns_rad, std::size_t k, double speed_mps) {
    return (turns_rad[k + 2 * kRateSteps] - turns_rad[k]) / (kRateS * speed_mps);
  };
  for (std::size_t k = 0; k < kOffsets; ++k) {
    const double x = (*to_rad)[k + kRateSteps] - (*from_rad)[k + kRateSteps];
    const double z =
        over_speed(*to_rad, k, pair.to.speed_mps) - over_speed(*from_rad, k, pair.from.speed_mps);
    Sums& s = sums_[k];
    s.x += w * x;
    s.z += w * z;
    s.xx += w * x * x;
    s.xz += w * x * z;
    s.zz += w * z * z;
    s.xy += w * x * y;
    s.zy += w * z * y;
  }
  weights_ += w;
  y_ += w * y;
  yy_ += w * y * y;
  ++judged_;
}

void SharedTurns::judge_gain(const Pair& pair) {
  const std::optional<Past> from = at(pair.from.time);
  const std::optional<Past> to = at(pair.to.time);
  if (!from || !to) return;
  ++gains_;
  const double step_s = to_seconds(pair.to.time - pair.from.time);
  const double gain_mps2 = (pair.to.speed_mps - pair.from.speed_mps) / step_s;
  const Eigen::Vector3d f_b_mps2 = (to->dv_b_mps - from->dv_b_mps) / step_s;
  gains_m2ps4_ += gain_mps2 * gain_mps2;
  gain_sum_mps2_ += gain_mps2;
  forces_mps2_ += f_b_mps2;
  force_squares_m2ps4_ += f_b_mps2.squaredNorm();
  gain_forces_m2ps4_ += gain_mps2 * f_b_mps2;
}

SharedTurns::Line SharedTurns::line(std::size_t k) const {
  const Sums& s = sums_[k];
  Eigen::Matrix2d A;
  A << s.xx - s.x * s.x / weights_, s.xz - s.x * s.z / weights_,  //
      s.xz - s.x * s.z / weights_, s.zz - s.z * s.z / weights_ + 1.0 / (kLeadSigmaM * kLeadSigmaM);
  const Eigen::Vector2d c(s.xy - s.x * y_ / weights_, s.zy - s.z * y_ / weights_);
  const double yy = yy_ - y_ * y_ / weights_;
  if (!(A.determinant() > kSingular * A(0, 0) * A(1, 1))) return {0.0, 0.0, yy, 0.0};
  const Eigen::Matrix2d inverse = A.inverse();
  const Eigen::Vector2d fit = inverse * c;
  return {fit[0], fit[1], yy - fit.dot(c), inverse(0, 0)};
}

TurnMatch SharedTurns::match() const {
  TurnMatch m;
  m.pairs = judged_;
  if (judged_ < kFewPairs) return m;
  std::array<double, kOffsets> residuals_rad2{};
  for (std::size_t k = 0; k < kOffsets; ++k) residuals_rad2[k] = line(k).residual_rad2;
  const auto best = static_cast<std::size_t>(
      std::min_element(residuals_rad2.begin(), residuals_rad2.end()) - residuals_rad2.begin());
  const Line fit = line(best);
  const double each = fit.residual_rad2 / static_cast<double>(judged_ - 4);
  const double yy = yy_ - y_ * y_ / weights_;
  if (!(fit.b_per_residual > 0.0) || !(yy > 0.0)) return m;
  m.ratio = fit.b;
  m.ratio_sigma = std::sqrt(each * fit.b_per_residual);
  m.lead_m = fit.l;
  m.correlation = std::copysign(std::sqrt(std::max(1.0 - fit.residual_rad2 / yy, 0.0)), fit.b);
  if (best == 0 || best + 1 == kOffsets) return m;
  const double before = residuals_rad2[best - 1];
  const double after = residuals_rad2[best + 1];
  const double bend = before - 2.0 * residuals_rad2[best] + after;
  m.offset_s = kStepS * (static_cast<double>(best) - kMostSteps + 0.5 * (before - after) / bend);
  const std::size_t believed =
      reach(residuals_rad2, best, each * kBelievedSigmas * kBelievedSigmas);
  m.offset_sigma_s = kStepS * std::max(std::sqrt(2.0 * each / bend),
                                       static_cast<double>(believed) / kBelievedSigmas);
  return m;
}

std::optional<Eigen::Vector3d> SharedTurns::forward_b() const {
  if (gains_ < kFewPairs) return std::nullopt;
  const auto n = static_cast<double>(gains_);
  const double gain_square = gains_m2ps4_ - gain_sum_mps2_ * gain_sum_mps2_ / n;
  if (!(gain_square > 0.0)) return std::nullopt;
  const Eigen::Vector3d w = (gain_forces_m2ps4_ - gain_sum_mps2_ / n * forces_mps2_) / gain_square;
  const double force_square = force_squares_m2ps4_ - forces_mps2_.squaredNorm() / n;
  const double left = std::max(force_square - w.squaredNorm() * gain_square, 0.0) / (3.0 * n);
  const double sigma = std::sqrt(left / gain_square);
  if (w.norm() < 5.0 * sigma) return std::nullopt;
  return w.normalized();
}

}  // namespace leeway::sim
