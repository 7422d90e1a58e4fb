#include "leeway/earth/time.hpp"

#include <cmath>
#include <string>

#include "leeway/earth/error.hpp"

namespace leeway {
namespace {

constexpr double kLimitS = 9.2e9;
constexpr double kWeekS = 604800.0;

}  // namespace

Duration duration_from_seconds(double seconds) {
  if (!(std::abs(seconds) < kLimitS)) {
    throw Error("time of " + std::to_string(seconds) + " s: must be finite and within +-9.2e9 s");
  }
  // Whole seconds apart from the fraction: the product with 1e9 would round away nanoseconds.
  const double whole_s = std::floor(seconds);
  return std::chrono::seconds{static_cast<std::int64_t>(whole_s)} +
         Duration{std::llround((seconds - whole_s) * 1e9)};
}

Time time_from_seconds(double seconds) { return Time{duration_from_seconds(seconds)}; }

Time time_from_gps(int week, double time_of_week_s) {
  if (week < 0 || week > kLastGpsWeek || !(time_of_week_s >= 0.0 && time_of_week_s <= kWeekS)) {
    throw Error("GPS time week " + std::to_string(week) + ", " + std::to_string(time_of_week_s) +
                " s: week must be 0 to 15000 and the time of week 0 to 604800 s");
  }
  return Time{week * std::chrono::weeks{1}} + duration_from_seconds(time_of_week_s);
}

}  // namespace leeway
