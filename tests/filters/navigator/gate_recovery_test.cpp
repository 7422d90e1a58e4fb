#include "leeway/navigator/gate_recovery.hpp"

#include <doctest/doctest.h>

#include <vector>

namespace leeway {
namespace {

using Remedy = GateRecovery::Remedy;

/// North along a meridian at 10 m/s.
GnssFix fix_at(double t_s, bool has_position = true) {
  const Geodetic place{45.0 * kRadPerDeg + 10.0 * t_s / 6.37e6, 0.0, 0.0};
  GnssFix fix{time_from_seconds(t_s)};
  if (has_position) fix.position = GnssPosition::from_geodetic(place, Eigen::Matrix3d::Identity());
  fix.velocity = GnssVelocity::from_ned(place, {10.0, 0.0, 0.0}, Eigen::Matrix3d::Identity());
  return fix;
}

/// What is done about n fixes refused in a row, one a second from begin_s on.
std::vector<Remedy> refused_in_a_row(GateRecovery& lock_out, int n, double begin_s,
                                     bool has_position = true) {
  std::vector<Remedy> remedies;
  for (int k = 0; k < n; ++k) {
    remedies.push_back(lock_out.refused(fix_at(begin_s + k, has_position)));
  }
  return remedies;
}

TEST_CASE("two refused in a row may be outliers, from the third on P widens, the tenth restarts") {
  GateRecovery lock_out;
  std::vector<Remedy> expected(10, Remedy::kWiden);
  expected[0] = expected[1] = Remedy::kWait;
  expected[9] = Remedy::kRestart;
  CHECK(refused_in_a_row(lock_out, 10, 0.0) == expected);
  CHECK(lock_out.is_row());
  REQUIRE(lock_out.since());
  CHECK(*lock_out.since() == time_from_seconds(0.0));
}

TEST_CASE("a fix that is fused ends the row") {
  GateRecovery lock_out;
  for (int k = 0; k < 20; ++k) {
    for (const Remedy remedy : refused_in_a_row(lock_out, 2, 10.0 * k)) {
      CHECK(remedy == Remedy::kWait);
    }
    lock_out.fused(fix_at(10.0 * k + 2.0));
    CHECK(!lock_out.is_row());
    CHECK(!lock_out.since());
  }
}

TEST_CASE("without a position there is nothing to restart from") {
  GateRecovery lock_out;
  CHECK(refused_in_a_row(lock_out, 12, 0.0, false).back() == Remedy::kWait);
  CHECK(lock_out.refused(fix_at(12.0)) == Remedy::kRestart);
}

TEST_CASE("a second restart within a minute is none: everything begins anew") {
  for (const double pause_s : {0.0, 100.0}) {
    GateRecovery lock_out;
    CHECK(refused_in_a_row(lock_out, 10, 0.0).back() == Remedy::kRestart);
    lock_out.end();
    CHECK(refused_in_a_row(lock_out, 10, 10.0 + pause_s).back() ==
          (pause_s > 0.0 ? Remedy::kRestart : Remedy::kRealign));
  }
}

TEST_CASE("the third lock-out within two minutes is not widened, unless all began anew") {
  for (const bool realigned : {false, true}) {
    GateRecovery lock_out;
    for (const double begin_s : {0.0, 20.0}) {
      CHECK(refused_in_a_row(lock_out, 3, begin_s).back() == Remedy::kWiden);
      lock_out.end();
    }
    if (realigned) lock_out.realigned(time_from_seconds(25.0));
    CHECK(refused_in_a_row(lock_out, 3, 100.0).back() ==
          (realigned ? Remedy::kWiden : Remedy::kRealign));
  }
}

TEST_CASE("locked out again soon after all began anew: fixes that agree win over the IMU") {
  GateRecovery lock_out;
  lock_out.realigned(time_from_seconds(0.0));
  CHECK_FALSE(lock_out.distrusts_imu());
  CHECK(refused_in_a_row(lock_out, 3, 10.0).back() == Remedy::kRestart);
  CHECK(lock_out.distrusts_imu());
  lock_out.end();
  CHECK(lock_out.refused(fix_at(13.0)) == Remedy::kRestart);
  GnssFix elsewhere = fix_at(14.0);
  elsewhere.position->r_e_m *= 1.0001;  // 637 m up
  lock_out.end();
  CHECK(lock_out.refused(elsewhere) == Remedy::kWait);
  for (int k = 0; k < 30; ++k) {
    CHECK(lock_out.distrusts_imu());
    lock_out.fused(fix_at(15.0 + k));
  }
  CHECK_FALSE(lock_out.distrusts_imu());
}

}  // namespace
}  // namespace leeway
