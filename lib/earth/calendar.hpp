/// @file
/// Dates as GPS time. Private to the library.
#pragma once

#include <optional>

#include "leeway/earth/time.hpp"

namespace leeway {

/// GPS time minus UTC at a time of UTC since the epoch of GPS, 1980-01-06.
Duration gps_minus_utc(Duration utc);

/// The begin of a day since the epoch of GPS, in its own calendar; nothing for a day that is none,
/// or not within 1980 to 2199.
std::optional<Duration> day_since_gps_epoch(int year, int month, int day);

}  // namespace leeway
