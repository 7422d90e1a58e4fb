#include "leeway/monitors/receiver_noise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "leeway/model/chi_square.hpp"

namespace leeway {
namespace {

constexpr double kLargestRatio = 4.0;       // of one fix: a single outlier is the gate's business
constexpr double kUnexplained = 16.3;      // 1e-3, 3 degrees of freedom
constexpr double kSmallestRatio = 0.125;   // of one fix: one in 18, six in a row once in 3e7
constexpr double kLastingSurprise = 3.8;   // 1e-2: of errors that last 30 s once in 50 min
constexpr double kRecentFixes = 10.0;
constexpr double kLargestNis = 30.0;         // one alone is no reason to doubt
constexpr double kLargestNisRatio = 25.0;   // two outliers in a row shall not count for ever
constexpr double kInconsistentRatio = 2.0;  // by a full window: once in 1e7
constexpr double kFalseAlarm = 1e-6;        // by fewer fixes
constexpr double kBandLow = 0.5;            // 90 degrees of freedom stay within with 99.99 %
constexpr double kBandHigh = 1.6;
constexpr double kLargestScale = 1000.0;
constexpr int kNoOutliers = 5;  // so many changes in a row beyond kLargestRatio: the claim is wrong
constexpr double kLongestIntervalS = 2.0;  // between longer ones the filter's own error changes too

/// Exponential mean that starts as the plain one.
void average(double& mean, std::int64_t& count, double value) {
  ++count;
  mean +=
      (value - mean) / static_cast<double>(std::min<std::int64_t>(count, ReceiverNoise::kWindow));
}

}  // namespace

bool ReceiverNoise::is_inconsistent() const {
  if (nis_ratio_ <= kInconsistentRatio) return false;
  const int dof = 3 * static_cast<int>(std::min<std::int64_t>(nis_count_, kWindow));
  return nis_ratio_ > chi_square_threshold(kFalseAlarm, dof) / dof;
}

bool ReceiverNoise::errors_last() const {
  return change_count_ >= kWindow && change_ratio_ < kBandLow;
}

void ReceiverNoise::begin_claims() {
  nis_ratio_ = recent_nis_ratio_ = 1.0;
  nis_count_ = 0;
  cusum_ = NisCusum{};
  mean_.setZero();
  is_surprising_ = false;
}

void ReceiverNoise::note_claim(double nis) {
  const double ratio = std::min(nis / 3.0, kLargestNisRatio);
  average(nis_ratio_, nis_count_, ratio);
  recent_nis_ratio_ += (ratio - recent_nis_ratio_) / kRecentFixes;
}

// The innovations of a right filter have no mean. Whitened by R they have the direction, by S the
// length.
void ReceiverNoise::note_mean(const Eigen::Vector3d& by_R, double nis) {
  constexpr double kShare = 0.125;                            // of the newest
  constexpr double kVariance = kShare / (2.0 - kShare);       // of each component of the mean
  constexpr double kBeyondChance = 31.0;                      // 3 degrees of freedom: 1e-6
  const double length = std::sqrt(std::min(nis, kLargestNis));
  mean_ += kShare * (length * by_R.normalized() - mean_);
  if (mean_.squaredNorm() < kBeyondChance * kVariance) return;
  is_surprising_ = true;
  mean_.setZero();
}

void ReceiverNoise::note(Time t, const Eigen::Vector3d& innovation, const Eigen::Matrix3d& R,
                         double nis, bool is_white) {
  note_claim(nis);
  is_surprising_ = is_white ? cusum_.push(nis, 3) : recent_nis_ratio_ > kLastingSurprise;
  if (is_white) note_mean(R.llt().matrixL().solve(innovation), nis);
  const bool in_a_row = previous_ && to_seconds(t - *previous_) <= kLongestIntervalS;
  const Eigen::Vector3d change = innovation - previous_innovation_;
  previous_ = t;
  previous_innovation_ = innovation;
  if (!in_a_row) return;
  constexpr double kExpected = 2.0 * 3.0;
  const double largest = kLargestRatio * sigma_scale_ * sigma_scale_;
  const double ratio = change.dot(R.llt().solve(change)) / kExpected;
  // A filter that foretells little explains such changes itself.
  const bool is_explained = shows_imu_ && nis < kUnexplained;
  surprises_ = ratio > largest && !is_explained ? surprises_ + 1 : 0;
  if (surprises_ > kNoOutliers) {
    sigma_scale_ = std::min(2.0 * sigma_scale_, kLargestScale);
    change_ratio_ = sigma_scale_ * sigma_scale_;
    return;
  }
  calms_ = ratio < kSmallestRatio * sigma_scale_ * sigma_scale_ ? calms_ + 1 : 0;
  if (calms_ > kNoOutliers && sigma_scale_ > 1.0) {
    sigma_scale_ = std::max(0.5 * sigma_scale_, 1.0);
    change_ratio_ = sigma_scale_ * sigma_scale_;
    calms_ = 0;
    return;
  }
  average(change_ratio_, change_count_, std::min(ratio, largest));
  if (change_count_ < kWindow) return;
  // Towards the scale that explains the changes, in about a window; a claim that would do by itself
  // is left alone.
  const bool would_do = change_ratio_ > kBandLow && change_ratio_ < kBandHigh;
  const double wanted = would_do ? 1.0 : std::sqrt(change_ratio_);
  const double moved = sigma_scale_ * std::pow(wanted / sigma_scale_, 1.0 / kWindow);
  sigma_scale_ = std::clamp(moved, smallest_, kLargestScale);
}

}  // namespace leeway
