#include "leeway/monitors/imu_screen.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace leeway {

bool ImuScreen::note(Axis& axis, double value, double dt_s, double least_noise) {
  // A rate times a step, divided by it again.
  constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();
  constexpr double kShare = 1.0 / 32.0;  // of the newest
  const double change = value - axis.value;
  const bool is_same = std::abs(change) <= kRounding * std::abs(value);
  axis.value = value;
  axis.held_s = is_same ? axis.held_s + dt_s : 0.0;
  axis.held = is_same ? std::min(axis.held + 1, kHeldIncrements) : 0;
  if (!is_same) {
    axis.mean_change += kShare * (std::abs(change) - axis.mean_change);
    axis.mean_bend += kShare * (std::abs(change - axis.change) - axis.mean_bend);
    axis.change = change;
  }
  const bool has_noise = axis.mean_change > least_noise && axis.mean_bend > axis.mean_change;
  return has_noise && axis.held == kHeldIncrements && axis.held_s >= kHeldS;
}

bool ImuScreen::is_held(const ImuIncrement& inc) {
  // What a log without noise is rounded to is far below, a MEMS sensor's noise above.
  constexpr double kLeastRadps = 1e-5;
  constexpr double kLeastMps2 = 1e-4;
  bool held = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const bool gyro = note(axes_[k], inc.dtheta_b_rad(i) / inc.dt_s, inc.dt_s, kLeastRadps);
    const bool accelerometer = note(axes_[3 + k], inc.dv_b_mps(i) / inc.dt_s, inc.dt_s, kLeastMps2);
    held = held || gyro || accelerometer;
  }
  return held;
}

}  // namespace leeway
