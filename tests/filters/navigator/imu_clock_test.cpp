#include "leeway/navigator/imu_clock.hpp"

#include <doctest/doctest.h>

#include <cstdint>

#include "leeway/sim/tools/random.hpp"

namespace leeway {
namespace {

constexpr double kGpsWeekS = 604800.0;
constexpr double kMaxJumpS = 60.0;
constexpr double kMaxGapS = 0.5;

ImuClock clock_at(double t_s) {
  ImuClock clock(kMaxJumpS, kMaxGapS);
  clock.set(time_from_seconds(t_s));
  return clock;
}

Verdict judge(ImuClock& clock, double t_s) { return clock.judge(time_from_seconds(t_s)); }

double newest_s(const ImuClock& clock) { return to_seconds(*clock.newest()); }

}  // namespace

TEST_CASE("the first record sets the clock; records in order are accepted, a second copy is not") {
  ImuClock clock(kMaxJumpS, kMaxGapS);
  CHECK_FALSE(clock.newest());
  CHECK(judge(clock, 123.0) == Verdict::kAccepted);
  CHECK(judge(clock, 123.0) == Verdict::kDuplicate);
  for (int k = 1; k <= 100; ++k) {
    CHECK(judge(clock, 123.0 + 0.01 * k) == Verdict::kAccepted);
    CHECK(judge(clock, 123.0 + 0.01 * k) == Verdict::kDuplicate);
  }
  CHECK(judge(clock, 124.0 + kMaxGapS) == Verdict::kAccepted);
  CHECK(newest_s(clock) == 124.5);
}

TEST_CASE("a single wild time is refused, and what follows on time goes on as if it had not been") {
  for (const double wild_s : {100.6, 130.0, 159.0, 161.0, 1e6, 4e9, 99.99, 90.0, 0.0, -1e6, -4e9}) {
    CAPTURE(wild_s);
    ImuClock clock = clock_at(100.0);
    CHECK(judge(clock, wild_s) == (wild_s > 100.0 ? Verdict::kFuture : Verdict::kOutOfOrder));
    CHECK(newest_s(clock) == 100.0);
    CHECK(judge(clock, 100.01) == Verdict::kAccepted);
    // And again: the first one is forgotten.
    CHECK(judge(clock, wild_s) == (wild_s > 100.0 ? Verdict::kFuture : Verdict::kOutOfOrder));
    CHECK(judge(clock, 100.02) == Verdict::kAccepted);
    CHECK(newest_s(clock) == 100.02);
  }
}

TEST_CASE("a hole of up to max_jump_s is believed when a second record confirms it") {
  for (const double hole_s : {0.51, 5.0, 59.9}) {
    CAPTURE(hole_s);
    ImuClock clock = clock_at(100.0);
    CHECK(judge(clock, 100.0 + hole_s) == Verdict::kFuture);
    CHECK(judge(clock, 100.01 + hole_s) == Verdict::kAccepted);
    CHECK(clock.newest() == time_from_seconds(100.01 + hole_s));
    CHECK(judge(clock, 100.02 + hole_s) == Verdict::kAccepted);
  }
}

TEST_CASE("five records in a row on another time line: the clock has jumped") {
  for (const double jump_s : {61.0, 1e5, 4e9 - 1000.0, -5.0, -1e5, -4e9}) {
    CAPTURE(jump_s);
    ImuClock clock = clock_at(100.0);
    const double begin_s = 100.0 + jump_s;
    for (int k = 0; k < 4; ++k) {
      CHECK(judge(clock, begin_s + 0.01 * k) ==
            (jump_s > 0.0 ? Verdict::kFuture : Verdict::kOutOfOrder));
      CHECK(newest_s(clock) == 100.0);
    }
    CHECK(judge(clock, begin_s + 0.04) == Verdict::kClockJump);
    CHECK(clock.newest() == time_from_seconds(begin_s + 0.04));
    CHECK(judge(clock, begin_s + 0.05) == Verdict::kAccepted);
  }
}

TEST_CASE("wild times that do not follow each other never add up to a jump") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed);
    ImuClock clock = clock_at(0.0);
    for (int k = 0; k < 1000; ++k) {
      // Anywhere within 10000 s, half a second apart by chance in 1 of 20000.
      const double t_s = -200.0 - 10'000.0 * random.uniform();
      CHECK(judge(clock, t_s) == Verdict::kOutOfOrder);
    }
    CHECK(newest_s(clock) == 0.0);
  }
}

TEST_CASE("seconds of week that begin anew are counted on, again and again") {
  ImuClock clock(kMaxJumpS, kMaxGapS);
  double expected_s = kGpsWeekS - 0.05;
  CHECK(judge(clock, expected_s) == Verdict::kAccepted);
  for (int week = 1; week <= 3; ++week) {
    CAPTURE(week);
    for (int k = -4; k <= 100; ++k) {
      const double time_of_week_s = k < 0 ? kGpsWeekS + 0.01 * k : 0.01 * k;
      CHECK(judge(clock, time_of_week_s) == Verdict::kAccepted);
      CHECK(clock.newest() == time_from_seconds(week * kGpsWeekS + 0.01 * k));
    }
    // What another sensor stamps before and after the end of the week is put where it belongs.
    CHECK(clock.counted_on(time_from_seconds(0.5)) == time_from_seconds(week * kGpsWeekS + 0.5));
    CHECK(clock.counted_on(time_from_seconds(kGpsWeekS - 0.5)) ==
          time_from_seconds(week * kGpsWeekS - 0.5));
    clock.set(time_from_seconds((week + 1) * kGpsWeekS - 0.05));
  }
}

TEST_CASE("a hole over the end of a week, and one record of it back") {
  ImuClock clock = clock_at(kGpsWeekS - 10.0);
  CHECK(judge(clock, 20.0) == Verdict::kFuture);
  CHECK(judge(clock, kGpsWeekS - 9.99) == Verdict::kAccepted);
  CHECK(judge(clock, 20.0) == Verdict::kFuture);
  CHECK(judge(clock, 20.01) == Verdict::kAccepted);
  CHECK(newest_s(clock) == kGpsWeekS + 20.01);
}

TEST_CASE("at the ends of possible time, 127 years from zero, nothing overflows") {
  const double furthest_s = 4e9;
  for (const double from_s : {-furthest_s, furthest_s}) {
    CAPTURE(from_s);
    ImuClock clock = clock_at(from_s);
    // The other end is 8e18 ns away, 9.22e18 is the most there is.
    const double to_s = -from_s;
    const Verdict refused = to_s > 0.0 ? Verdict::kFuture : Verdict::kOutOfOrder;
    const double step_s = to_s > 0.0 ? -0.01 : 0.0;
    for (int k = 0; k < 4; ++k) {
      CHECK(judge(clock, to_s + 0.01 * k + 5.0 * step_s) == refused);
    }
    CHECK(judge(clock, to_s + 0.04 + 5.0 * step_s) == Verdict::kClockJump);
    CHECK(clock.newest() == time_from_seconds(to_s + 0.04 + 5.0 * step_s));
    CHECK(judge(clock, from_s) == (from_s > 0.0 ? Verdict::kFuture : Verdict::kOutOfOrder));
  }
}

}  // namespace leeway
