/// @file
/// What the columns of the logs have in common. Private to the log readers.
#pragma once

#include <limits>

#include "leeway/sensors/gnss_fix.hpp"
#include "lib/logs/text_fields.hpp"

namespace leeway {

inline constexpr double kSmallest = std::numeric_limits<double>::min();  ///< positive
inline constexpr double kMaxSigma = 1e5;
inline constexpr double kMaxHeightM = 1e5;
inline constexpr double kMaxSpeedMps = 1e4;

inline constexpr Column kTimeColumn{Column::kTime};

constexpr Column sigma_column(int slot, bool optional = false) {
  return {slot, kLeastSigma, kMaxSigma, optional};
}

constexpr Column velocity_column(int slot) { return {slot, -kMaxSpeedMps, kMaxSpeedMps, true}; }

}  // namespace leeway
