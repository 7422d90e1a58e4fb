#include "leeway/sim/motion/trajectory.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/sim/motion/central_difference.hpp"
#include "tests/sim/tools/reference_table.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

using test::near;

std::vector<Trajectory> all_trajectories() {
  return {static_trajectory({.attitude = {0.1, -0.2, 2.0}}),
          straight({.climb_rate_mps = 2.0, .heading_rad = 1.0}),
          circle(),
          square_loop({.duration_s = 300.0}),
          car_drive({.duration_s = 600.0}),
          circle20(),
          manoeuvre_car()};
}

Eigen::Vector3d omega_eb_b(const TruthPoint& truth) {
  return truth.omega_ib_b_radps -
         truth.nav.q_eb.toRotationMatrix().transpose() * earth_rotation_e_radps();
}

}  // namespace

TEST_CASE("velocity is the derivative of position") {
  for (const Trajectory& trajectory : all_trajectories()) {
    for (double t_s = 0.37; t_s < trajectory.duration_s - 0.1; t_s += 1.13) {
      if (!is_smooth_at(trajectory, t_s)) continue;
      CAPTURE(trajectory.name);
      CAPTURE(t_s);
      const auto position = [&](double t) { return truth_at(trajectory, t).nav.r_e_m; };
      // Rounding 9e-10 m over a 5 ms step, and h^4/30 times a fifth derivative of up to 500 m/s^5.
      CHECK(near(truth_at(trajectory, t_s).nav.v_e_mps, rate_of(position, t_s, 5e-3), 1e-6));
    }
  }
}

TEST_CASE("the derivative of velocity is specific force, Coriolis and gravity") {
  for (const Trajectory& trajectory : all_trajectories()) {
    for (double t_s = 0.37; t_s < trajectory.duration_s - 0.1; t_s += 1.13) {
      if (!is_smooth_at(trajectory, t_s)) continue;
      CAPTURE(trajectory.name);
      CAPTURE(t_s);
      const TruthPoint truth = truth_at(trajectory, t_s);
      const auto velocity = [&](double t) { return truth_at(trajectory, t).nav.v_e_mps; };
      const Eigen::Vector3d expected = truth.nav.q_eb * truth.f_ib_b_mps2 -
                                       2.0 * earth_rotation_e_radps().cross(truth.nav.v_e_mps) +
                                       gravity_e<GravityModel::kNormal>(truth.nav.r_e_m);
      // Rounding 4e-15 m/s over a 1 ms step; the fifth derivative costs below 1e-9.
      CHECK(near(rate_of(velocity, t_s, 1e-3), expected, 2e-9));
    }
  }
}

TEST_CASE("the body turns at the angular rate") {
  const double h_s = 1e-3;
  for (const Trajectory& trajectory : all_trajectories()) {
    for (double t_s = 0.37; t_s < trajectory.duration_s - 0.1; t_s += 1.13) {
      if (!is_smooth_at(trajectory, t_s)) continue;
      CAPTURE(trajectory.name);
      CAPTURE(t_s);
      const auto turn = [&](double h) -> Eigen::Vector3d {
        const Eigen::Quaterniond before = truth_at(trajectory, t_s - h).nav.q_eb;
        return log_quaternion(before.conjugate() * truth_at(trajectory, t_s + h).nav.q_eb);
      };
      const Eigen::Vector3d rate = (8.0 * turn(h_s) - turn(2.0 * h_s)) / (12.0 * h_s);
      // Rounding 2e-16 rad over 2 ms, and h^4 times a fifth derivative of up to 1e3 rad/s^5.
      CHECK(near(omega_eb_b(truth_at(trajectory, t_s)), rate, 2e-9));
    }
  }
}

TEST_CASE("truth agrees with the reference vectors" * doctest::test_suite("heavy")) {
  struct Case {
    const char* vector;
    Trajectory trajectory;
  };
  const Case cases[] = {
      {"circle20", circle20()},
      {"manoeuvre_car", manoeuvre_car()},
      {"static_lat45",
       static_trajectory({.attitude = {-3.0 * kRadPerDeg, 5.0 * kRadPerDeg, 30.0 * kRadPerDeg}})}};
  for (const Case& c : cases) {
    const auto rows = test::reference_table(std::string(c.vector) + "/truth.csv.gz");
    if (rows.empty()) {
      MESSAGE("skipped: no reference vector " << c.vector);
      continue;
    }
    CAPTURE(c.vector);
    for (const auto& row : rows) {
      const double t_s = row[0];
      CAPTURE(t_s);
      const TruthPoint truth = truth_at(c.trajectory, t_s);
      const Eigen::Map<const Eigen::Vector3d> r_e_m(&row[1]), v_e_mps(&row[4]), f(&row[11]),
          w(&row[14]);
      const Eigen::Quaterniond q_eb(row[7], row[8], row[9], row[10]);
      REQUIRE(near(truth.nav.r_e_m, r_e_m, 2e-9));       // two units in the last place of 6e6 m
      REQUIRE(near(truth.nav.v_e_mps, v_e_mps, 1e-13));  // phase of 1e3 rad to 1e-13, times 0.1 m/s
      // Phase again; the angles are of 6 rad or of 0.05 rad at 1000 rad of phase.
      REQUIRE(log_quaternion(q_eb.conjugate() * truth.nav.q_eb).norm() < 2e-14);
      REQUIRE(near(truth.f_ib_b_mps2, f, 2e-13));       // attitude times 10 m/s^2
      REQUIRE(near(truth.omega_ib_b_radps, w, 1e-13));  // phase times 4 rad/s^2
    }
  }
}

TEST_CASE("a resting body on the Earth feels gravity and the Earth's turn, and the time is kept") {
  const Trajectory trajectory = static_trajectory({.attitude = {0.0, 0.0, 0.0}});
  const TruthPoint truth = truth_at(trajectory, 12.5);
  CHECK(truth.nav.time == time_from_seconds(12.5));
  CHECK(truth.nav.v_e_mps == Eigen::Vector3d::Zero());
  const double rate = wgs84::kRotationRateRadps * std::sqrt(0.5);
  CHECK(near(truth.omega_ib_b_radps, Eigen::Vector3d(rate, 0.0, -rate), 1e-19));
  // Somigliana at 45 degrees with free air over 100 m: 9.806199 - 3.0855e-4 m/s^2; horizontal
  // below 1e-6.
  CHECK(near(truth.f_ib_b_mps2, Eigen::Vector3d(0.0, 0.0, -9.805891), 2e-6));
}

TEST_CASE("a trajectory without a motion is refused") {
  CHECK_THROWS_AS(truth_at(Trajectory{}, 0.0), Error);
}

}  // namespace leeway::sim
