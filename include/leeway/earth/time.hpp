/// @file
/// Time: integer nanoseconds on one continuous scale (no leap seconds), as a strong type.
#pragma once

#include <chrono>
#include <cstdint>

namespace leeway {

/// The time scale of a log, which all sensors of a run share. Its epoch is the log's: that of GPS
/// time where the log says so, the start of the recording elsewhere.
struct NavClock {};

using Duration = std::chrono::nanoseconds;
using Time = std::chrono::time_point<NavClock, Duration>;

/// Seconds rounded to the nearest nanosecond. Domain |seconds| < 9.2e9 (292 years).
/// @throws Error outside the domain or when not finite.
Duration duration_from_seconds(double seconds);
Time time_from_seconds(double seconds);

inline constexpr int kLastGpsWeek = 15000;  ///< larger numbers are damaged data

/// GPS time from week number (not rolled over) and seconds of week.
/// @throws Error unless 0 <= week <= kLastGpsWeek and 0 <= time_of_week_s <= 604800.
Time time_from_gps(int week, double time_of_week_s);

/// Seconds as a double, correctly rounded within 104 days of zero: whole seconds are whole.
constexpr double to_seconds(Duration d) { return static_cast<double>(d.count()) / 1e9; }
constexpr double to_seconds(Time t) { return to_seconds(t.time_since_epoch()); }

}  // namespace leeway
