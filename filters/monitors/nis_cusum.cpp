#include "leeway/monitors/nis_cusum.hpp"

#include <algorithm>
#include <cmath>

namespace leeway {

bool NisCusum::push(double nis, int dof) {
  constexpr double kVarianceRatio = 4.0;
  constexpr double kAlarm = 10.0;
  constexpr double kLargestNis = 28.0;  // one alone is no alarm
  const double log_ratio =
      0.5 * ((1.0 - 1.0 / kVarianceRatio) * std::min(nis, kLargestNis) - dof * std::log(kVarianceRatio));
  if (!std::isfinite(log_ratio)) return false;
  sum_ = std::max(0.0, sum_ + log_ratio);
  if (sum_ < kAlarm) return false;
  sum_ = 0.0;
  return true;
}

}  // namespace leeway
