#include "leeway/filters/lock_out.hpp"

#include <doctest/doctest.h>

#include <vector>

namespace leeway {
namespace {

using Remedy = LockOut::Remedy;

/// What is done about n fixes refused in a row, one a second from begin_s on.
std::vector<Remedy> refused_in_a_row(LockOut& lock_out, int n, double begin_s,
                                     bool has_position = true) {
  std::vector<Remedy> remedies;
  for (int k = 0; k < n; ++k) {
    remedies.push_back(lock_out.refused(time_from_seconds(begin_s + k), has_position));
  }
  return remedies;
}

TEST_CASE("two refused in a row may be outliers, from the third on P widens, the tenth restarts") {
  LockOut lock_out;
  std::vector<Remedy> expected(10, Remedy::kWiden);
  expected[0] = expected[1] = Remedy::kWait;
  expected[9] = Remedy::kRestart;
  CHECK(refused_in_a_row(lock_out, 10, 0.0) == expected);
  CHECK(lock_out.is_row());
  REQUIRE(lock_out.since());
  CHECK(*lock_out.since() == time_from_seconds(0.0));
}

TEST_CASE("a fix that is fused ends the row") {
  LockOut lock_out;
  for (int k = 0; k < 20; ++k) {
    for (const Remedy remedy : refused_in_a_row(lock_out, 2, 10.0 * k)) {
      CHECK(remedy == Remedy::kWait);
    }
    lock_out.end();
    CHECK(!lock_out.is_row());
    CHECK(!lock_out.since());
  }
}

TEST_CASE("without a position there is nothing to restart from") {
  LockOut lock_out;
  CHECK(refused_in_a_row(lock_out, 12, 0.0, false).back() == Remedy::kWait);
  CHECK(lock_out.refused(time_from_seconds(12.0), true) == Remedy::kRestart);
}

TEST_CASE("a second restart within a minute is none: everything begins anew") {
  for (const double pause_s : {0.0, 100.0}) {
    LockOut lock_out;
    CHECK(refused_in_a_row(lock_out, 10, 0.0).back() == Remedy::kRestart);
    lock_out.end();
    CHECK(refused_in_a_row(lock_out, 10, 10.0 + pause_s).back() ==
          (pause_s > 0.0 ? Remedy::kRestart : Remedy::kRealign));
  }
}

TEST_CASE("the third lock-out within two minutes is not widened; forget() forgets the others") {
  for (const bool forgets : {false, true}) {
    LockOut lock_out;
    for (const double begin_s : {0.0, 20.0}) {
      CHECK(refused_in_a_row(lock_out, 3, begin_s).back() == Remedy::kWiden);
      lock_out.end();
    }
    if (forgets) lock_out.forget();
    CHECK(refused_in_a_row(lock_out, 3, 40.0).back() ==
          (forgets ? Remedy::kWiden : Remedy::kRealign));
  }
}

}  // namespace
}  // namespace leeway
