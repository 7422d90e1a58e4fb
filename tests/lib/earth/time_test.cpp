#include "leeway/earth/time.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "leeway/earth/error.hpp"

namespace leeway {

TEST_CASE("seconds round to the nearest nanosecond and back") {
  CHECK(time_from_seconds(1.5).time_since_epoch().count() == 1'500'000'000);
  CHECK(time_from_seconds(-0.25).time_since_epoch().count() == -250'000'000);
  CHECK(time_from_seconds(0.24610395699739457).time_since_epoch().count() == 246'103'957);
  CHECK(time_from_seconds(408640.961).time_since_epoch().count() == 408'640'961'000'000);
  CHECK(to_seconds(time_from_seconds(408640.961)) == 408640.961);
  CHECK(to_seconds(std::chrono::seconds{499}) == 499.0);  // 2026-11-24: was 499.00000000000006
}

TEST_CASE("GPS week and time of week share one line across the rollover of the week") {
  CHECK(time_from_gps(2381, 604800.0) == time_from_gps(2382, 0.0));
  CHECK(time_from_gps(0, 0.0) == Time{});
  CHECK(to_seconds(time_from_gps(2382, 0.125) - time_from_gps(2381, 604799.875)) == 0.25);
}

TEST_CASE("times outside the domain are refused") {
  CHECK_THROWS_AS(time_from_seconds(std::numeric_limits<double>::quiet_NaN()), Error);
  CHECK_THROWS_AS(time_from_seconds(std::numeric_limits<double>::infinity()), Error);
  CHECK_THROWS_AS(time_from_seconds(9.3e9), Error);
  CHECK_THROWS_AS(time_from_gps(-1, 0.0), Error);
  CHECK_THROWS_AS(time_from_gps(2381, 604800.5), Error);
}

}  // namespace leeway
