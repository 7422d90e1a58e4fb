#include "leeway/sensors/imu.hpp"

#include <doctest/doctest.h>

#include <cstdint>

#include "tests/support/near.hpp"

namespace leeway {

using test::near;

TEST_CASE("what a rate sample means decides the increment") {
  const ImuSample from{time_from_seconds(10.0), {1.0, 2.0, 3.0}, {10.0, 20.0, 30.0}};
  const ImuSample to{time_from_seconds(10.25), {3.0, 6.0, -1.0}, {30.0, -20.0, 50.0}};
  const auto increment = [&](RateMeaning meaning) { return increment_between(from, to, meaning); };
  for (const RateMeaning meaning :
       {RateMeaning::kMean, RateMeaning::kPoint, RateMeaning::kPointHeld}) {
    CHECK(increment(meaning).time == to.time);
    CHECK(increment(meaning).dt_s == 0.25);
  }
  // All numbers are exact in binary.
  CHECK(increment(RateMeaning::kMean).dtheta_b_rad == Eigen::Vector3d(0.75, 1.5, -0.25));
  CHECK(increment(RateMeaning::kMean).dv_b_mps == Eigen::Vector3d(7.5, -5.0, 12.5));
  CHECK(increment(RateMeaning::kPoint).dtheta_b_rad == Eigen::Vector3d(0.5, 1.0, 0.25));
  CHECK(increment(RateMeaning::kPoint).dv_b_mps == Eigen::Vector3d(5.0, 0.0, 10.0));
  CHECK(increment(RateMeaning::kPointHeld).dtheta_b_rad == Eigen::Vector3d(0.25, 0.5, 0.75));
  CHECK(increment(RateMeaning::kPointHeld).dv_b_mps == Eigen::Vector3d(2.5, 5.0, 7.5));
}

TEST_CASE("the interval is exact far from the epoch, where a double holds 0.1 us") {
  const ImuSample from{time_from_gps(2381, 408640.960)};
  const ImuSample to{time_from_gps(2381, 408640.965)};
  CHECK(increment_between(from, to, RateMeaning::kMean).dt_s == 0.005);
}

TEST_CASE("split conserves times and sums, and shares by time") {
  const ImuIncrement inc{
      time_from_seconds(100.01), 0.01, {1e-3, -2e-3, 7e-4}, {0.02, 0.01, -0.098}};
  for (const std::int64_t after_ns :
       {std::int64_t{1}, std::int64_t{2'500'000}, std::int64_t{9'999'999}}) {
    CAPTURE(after_ns);
    const Time t = inc.time - Duration{after_ns};
    const auto [before, after] = split(inc, t);
    CHECK(before.time == t);
    CHECK(after.time == inc.time);
    CHECK(after.dt_s == to_seconds(inc.time - t));
    // ulp(0.01) = 1.7e-18, ulp(0.1) = 1.4e-17
    CHECK(near(before.dt_s + after.dt_s, inc.dt_s, 1.8e-18));
    CHECK(before.dt_s > 0.0);
    CHECK(near(before.dtheta_b_rad + after.dtheta_b_rad, inc.dtheta_b_rad, 1.8e-18));
    CHECK(near(before.dv_b_mps + after.dv_b_mps, inc.dv_b_mps, 1.4e-17));
    const double share = static_cast<double>(after_ns) / 1e7;
    CHECK(near(after.dtheta_b_rad, share * inc.dtheta_b_rad, 4e-18));
    CHECK(near(after.dv_b_mps, share * inc.dv_b_mps, 3e-17));
  }
}

}  // namespace leeway
