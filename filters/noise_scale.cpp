#include "leeway/filters/noise_scale.hpp"

#include <algorithm>
#include <cmath>

namespace leeway {
namespace {

constexpr double kWindow = 30.0;
constexpr double kLargestRatio = 4.0;  // of one fix: a single outlier is the gate's business
constexpr double kBandLow = 0.5;       // 90 degrees of freedom stay within with 99.99 %
constexpr double kBandHigh = 1.6;
constexpr double kSmallestScale = 0.5;
constexpr double kLargestScale = 10.0;

}  // namespace

void NoiseScale::note(double nis, int dof) {
  const double ratio = std::min(nis / dof, kLargestRatio);
  ++count_;
  const double window = std::min(static_cast<double>(count_), kWindow);
  nis_ratio_ += (ratio - nis_ratio_) / window;
  if (window < kWindow || (nis_ratio_ > kBandLow && nis_ratio_ < kBandHigh)) return;
  // Towards the scale at which the mean is 1, over a window, since S holds more than R.
  const double step = 0.5 * (std::min(nis_ratio_, 2.0) - 1.0) / kWindow;
  sigma_scale_ = std::clamp(sigma_scale_ * std::exp(step), kSmallestScale, kLargestScale);
}

}  // namespace leeway
