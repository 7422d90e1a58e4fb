#include "leeway/filters/noise_scale.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace leeway {
namespace {

constexpr double kLargestRatio = 4.0;  // of one fix: a single outlier is the gate's business
constexpr double kBandLow = 0.5;       // 90 degrees of freedom stay within with 99.99 %
constexpr double kBandHigh = 1.6;
constexpr double kLargestScale = 10.0;
constexpr double kLongestIntervalS = 2.0;  // between longer ones the filter's own error changes too

/// Exponential mean that starts as the plain one.
void average(double& mean, std::int64_t& count, double value) {
  ++count;
  mean += (value - mean) / static_cast<double>(std::min<std::int64_t>(count, NoiseScale::kWindow));
}

}  // namespace

void NoiseScale::note(Time t, const Eigen::Vector3d& innovation, const Eigen::Matrix3d& R,
                      double nis) {
  average(nis_ratio_, nis_count_, std::min(nis / 3.0, kLargestRatio));
  const bool in_a_row = previous_ && to_seconds(t - *previous_) <= kLongestIntervalS;
  const Eigen::Vector3d change = innovation - previous_innovation_;
  previous_ = t;
  previous_innovation_ = innovation;
  if (!in_a_row) return;
  const double expected = 2.0 * 3.0 * sigma_scale_ * sigma_scale_;
  const double ratio = change.dot(R.llt().solve(change)) / expected;
  average(change_ratio_, change_count_, std::min(ratio, kLargestRatio));
  if (change_count_ < kWindow) return;
  const auto in_band = [](double r) { return r > kBandLow && r < kBandHigh; };
  // A claim that would do by itself is left alone again: what a hole or a jump has taught is
  // forgotten in about a window.
  if (in_band(change_ratio_ * sigma_scale_ * sigma_scale_)) {
    sigma_scale_ = std::pow(sigma_scale_, 1.0 - 1.0 / kWindow);
    return;
  }
  if (in_band(change_ratio_)) return;
  // Towards the scale at which the mean is 1, in about a window.
  const double step = 0.5 * (std::min(change_ratio_, 2.0) - 1.0) / kWindow;
  sigma_scale_ = std::clamp(sigma_scale_ * std::exp(step), smallest_, kLargestScale);
}

}  // namespace leeway
