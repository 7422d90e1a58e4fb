#include "leeway/monitors/lag_fit.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace leeway {
namespace {

constexpr double kSlowS = 3.0;        // accelerations in traffic last for some seconds
constexpr double kSettlesS = 10.0;    // until what is slow is known
constexpr double kMemoryS = 240.0;    // what is older counts by less than a third
constexpr double kHeadingRad = 0.05;  // 3 deg: what a heading may be wrong by
constexpr double kLeastAgeS = 0.04;   // receivers' velocities lag by half an epoch: 25 ms at 20 Hz
constexpr double kBeyondChanceSigmas = 4.5;
constexpr double kTellingSquares = 20.0;  // squared sigmas by which an age explains more than none
constexpr double kLeastDof = 60.0;
constexpr double kHuberSigmas = 3.0;
constexpr int kLevelDof = 2;
constexpr double kPriorDof = 10.0;  // a claim is believed like five measurements
constexpr double kLeastScale2 = 0.01;
constexpr double kLargestScale2 = 1e4;

}  // namespace

void LagFit::Cell::add(const Fast& fast, double kept, double weight) {
  const auto fade = [&](double& sum, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    sum = kept * sum + weight * a.dot(b);
  };
  fade(ee, fast.excess, fast.excess);
  fade(es, fast.excess, fast.slope);
  fade(ss, fast.slope, fast.slope);
  fade(et, fast.excess, fast.turn);
  fade(st, fast.slope, fast.turn);
  fade(tt, fast.turn, fast.turn);
}

// The heading's error is the best one for each age, as far as it is possible.
LagFit::Parabola::Parabola(const Cell& cell) {
  const double turn = cell.tt + 1.0 / (kHeadingRad * kHeadingRad);
  ee = cell.ee - cell.et * cell.et / turn;
  es = cell.es - cell.et * cell.st / turn;
  ss = cell.ss - cell.st * cell.st / turn;
}

double LagFit::Parabola::change_s() const {
  constexpr double kHalfStepS = 0.5 * AgeGrid::kStepS;
  return ss > 0.0 ? std::clamp(-es / ss, -kHalfStepS, kHalfStepS) : 0.0;
}

/// What a fading-memory filter of level and ramp has not foreseen: Brown's double smoothing.
Eigen::Vector3d LagFit::fast_part(Slow& slow, const Eigen::Vector3d& value, double dt_s) const {
  if (!last_s_) {
    slow = {value, Eigen::Vector3d::Zero()};
    return Eigen::Vector3d::Zero();
  }
  const double kept = std::exp(-dt_s / kSlowS);
  const Eigen::Vector3d unforeseen = value - slow.level - slow.ramp * dt_s;
  slow.level = value - kept * kept * unforeseen;
  slow.ramp += (1.0 - kept) * (1.0 - kept) / dt_s * unforeseen;
  return unforeseen;
}

void LagFit::add(const Pairs& pairs, const Eigen::Vector3d& down, double sigma, double t_s) {
  if (last_s_ && t_s - *last_s_ > kSlowS) restart();  // too far apart to foresee anything
  const double dt_s = t_s - last_s_.value_or(t_s);
  if (last_s_ && !(dt_s > 0.0)) return;
  const auto level = [&](const Eigen::Vector3d& v) {
    return Eigen::Vector3d((v - down * down.dot(v)) / sigma);
  };
  Fasts fasts;
  for (std::size_t k = 0; k < AgeGrid::kCount; ++k) {
    const auto& [measured, motion, slope] = pairs[k];
    Cell& cell = cells_[k];
    fasts[k] = {level(fast_part(cell.excess, measured - motion, dt_s)),
                level(fast_part(cell.slope, slope, dt_s)),
                level(down.cross(fast_part(cell.motion, motion, dt_s)))};
  }
  last_s_ = t_s;
  settled_s_ += dt_s;
  if (settled_s_ > kSettlesS) sum_up(fasts, dt_s);
}

void LagFit::sum_up(const Fasts& fasts, double dt_s) {
  double least2 = fasts[0].excess.squaredNorm();
  for (std::size_t k = 0; k < AgeGrid::kCount; ++k) {
    const double change_s = Parabola(cells_[k]).change_s();
    least2 = std::min(least2, (fasts[k].excess + change_s * fasts[k].slope).squaredNorm());
  }
  // Huber's weight: an outlier, which no age explains, counts as what is at the rim.
  const double rim = kHuberSigmas * std::sqrt(kLevelDof * scale2_);
  const double weight = std::min(1.0, rim / std::max(std::sqrt(least2), 1e-9));
  const double kept = std::exp(-dt_s / kMemoryS);
  for (std::size_t k = 0; k < AgeGrid::kCount; ++k) cells_[k].add(fasts[k], kept, weight);
  weight_sum_ = kept * weight_sum_ + weight;
  fit();
}

void LagFit::fit() {
  std::size_t best = 0;
  double least = Parabola(cells_[0]).least();
  for (std::size_t k = 1; k < AgeGrid::kCount; ++k) {
    const double left = Parabola(cells_[k]).least();
    if (left < least) best = k;
    least = std::min(left, least);
  }
  const double dof = kLevelDof * weight_sum_;
  scale2_ = std::clamp((least + kPriorDof) / (dof + kPriorDof), kLeastScale2, kLargestScale2);
  const Parabola parabola(cells_[best]);
  if (!(parabola.ss > 0.0) || dof < kLeastDof) return;
  age_.value_s = AgeGrid::at(best) + parabola.change_s();
  age_.sigma_s = std::min(1.0, std::sqrt(scale2_ / parabola.ss));
  const double gain = Parabola(cells_[AgeGrid::kHalf]).left(0.0) - least;
  const double bound_s = std::max(kLeastAgeS, kBeyondChanceSigmas * age_.sigma_s);
  age_.beyond_chance = std::abs(age_.value_s) > bound_s && gain > kTellingSquares * scale2_;
}

}  // namespace leeway
