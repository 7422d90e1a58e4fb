#include "lib/earth/calendar.hpp"

#include <algorithm>
#include <array>
#include <chrono>

namespace leeway {
namespace {

constexpr std::chrono::sys_days kGpsEpoch = std::chrono::year{1980} / 1 / 6;

// The dates (UTC) from which GPS time is one second more ahead of UTC. Source: IERS Bulletin C.
constexpr std::array<std::chrono::sys_days, 18> kLeapSeconds{
    std::chrono::year{1981} / 7 / 1, std::chrono::year{1982} / 7 / 1,
    std::chrono::year{1983} / 7 / 1, std::chrono::year{1985} / 7 / 1,
    std::chrono::year{1988} / 1 / 1, std::chrono::year{1990} / 1 / 1,
    std::chrono::year{1991} / 1 / 1, std::chrono::year{1992} / 7 / 1,
    std::chrono::year{1993} / 7 / 1, std::chrono::year{1994} / 7 / 1,
    std::chrono::year{1996} / 1 / 1, std::chrono::year{1997} / 7 / 1,
    std::chrono::year{1999} / 1 / 1, std::chrono::year{2006} / 1 / 1,
    std::chrono::year{2009} / 1 / 1, std::chrono::year{2012} / 7 / 1,
    std::chrono::year{2015} / 7 / 1, std::chrono::year{2017} / 1 / 1};

}  // namespace

Duration gps_minus_utc(Duration utc) {
  const auto passed = std::count_if(kLeapSeconds.begin(), kLeapSeconds.end(),
                                    [&](auto date) { return utc >= date - kGpsEpoch; });
  return std::chrono::seconds{passed};
}

std::optional<Duration> day_since_gps_epoch(int year, int month, int day) {
  const bool is_plausible =
      year >= 1980 && year < 2200 && month >= 1 && month <= 12 && day >= 1 && day <= 31;
  if (!is_plausible) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{year},
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date) - kGpsEpoch;
}

}  // namespace leeway
