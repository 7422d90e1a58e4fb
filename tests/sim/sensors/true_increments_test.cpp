#include "leeway/sim/sensors/true_increments.hpp"

#include <doctest/doctest.h>

#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

using test::near;

void check_same(const ImuIncrement& a, const ImuIncrement& b) {
  CHECK(a.time == b.time);
  CHECK(a.dt_s == b.dt_s);
  // Rates and forces of the trajectory round by 1e-13; a late time by more than an early one.
  CHECK(near(a.dtheta_b_rad, b.dtheta_b_rad, 1e-13));
  CHECK(near(a.dv_b_mps, b.dv_b_mps, 1e-12));
}

}  // namespace

TEST_CASE("a periodic motion is stored for one period, and later increments are right" *
          doctest::test_suite("heavy")) {
  const Trajectory loop = square_loop();
  // 30 Hz: increments of 33333333 and 33333334 ns, whose pattern repeats within the period.
  for (const double rate_hz : {50.0, 30.0}) {
    const TrueIncrements table(loop, rate_hz, 3600.0);
    CHECK(table.stored() == static_cast<std::size_t>(240.0 * rate_hz));
    REQUIRE(table.size() == static_cast<std::size_t>(3600.0 * rate_hz));
    for (std::size_t k = 0; k < table.size(); k += 997) {
      CAPTURE(k);
      const auto at = static_cast<double>(k);
      check_same(table[k], true_increment(loop, at / rate_hz, (at + 1.0) / rate_hz));
    }
  }
}

TEST_CASE("a motion that does not repeat within whole increments is stored as it is" *
          doctest::test_suite("heavy")) {
  const Trajectory circle_without_end = circle({.radius_m = 100.0, .speed_mps = 20.0});
  for (const auto& [trajectory, rate_hz] :
       {std::pair{car_drive(), 50.0}, std::pair{circle_without_end, 50.0},
        std::pair{square_loop(), 0.31}}) {
    const auto expected = true_increments(trajectory, rate_hz, 500.0);
    const TrueIncrements table(trajectory, rate_hz, 500.0, 2);
    REQUIRE(table.size() == expected.size());
    CHECK(table.stored() == expected.size());
    for (std::size_t k = 0; k < table.size(); ++k) {
      REQUIRE(table[k].time == expected[k].time);
      REQUIRE(table[k].dtheta_b_rad == expected[k].dtheta_b_rad);
      REQUIRE(table[k].dv_b_mps == expected[k].dv_b_mps);
    }
  }
}

TEST_CASE("shorter than its period, and nothing at all") {
  CHECK(TrueIncrements(square_loop(), 50.0, 10.0).stored() == 500);
  CHECK(TrueIncrements(square_loop(), 50.0, 0.0).size() == 0);
}

TEST_CASE("what would not fit into memory is refused before it is tried") {
  CHECK_THROWS_AS(TrueIncrements(car_drive({.duration_s = 1e5}), 1e6, 1e5), Error);
}

}  // namespace leeway::sim
