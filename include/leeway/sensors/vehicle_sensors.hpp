/// @file
/// Readings of a vehicle's own simple sensors. Any of them may be missing.
#pragma once

#include "leeway/earth/time.hpp"

namespace leeway {

/// Speed of the driven or rolling rear wheels: forwards positive, backwards negative.
struct OdometerSpeed {
  Time time{};
  double speed_mps{};
  double sigma_mps{0.1};  ///< beyond a constant scale error, which is estimated
};

/// Height from air pressure, by whatever atmosphere: a constant offset is estimated.
struct BarometricHeight {
  Time time{};
  double height_m{};
  double sigma_m{0.5};  ///< beyond the slow change of the weather
};

/// Whether a reading can be used: finite, the sigma at least kLeastSigma (gnss_fix.hpp), the value
/// one that a vehicle can have.
bool is_usable(const OdometerSpeed& odometer);
bool is_usable(const BarometricHeight& barometer);

}  // namespace leeway
