#include "leeway/model/gnss_measurement.hpp"

#include <doctest/doctest.h>

#include "leeway/sim/motion/trajectories.hpp"
#include "tests/filters/model/random_state.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;
using test::random_estimate;
using test::random_vector;

struct Setup {
  Estimate estimate{};
  Eigen::Vector3d lever_b_m{};
  Eigen::Vector3d omega_b_radps{};
};

/// Lever arms of 0.5 to 5 m, rates to 3 rad/s.
Setup random_setup(std::uint64_t seed) {
  sim::Random random(seed, 2);
  const Eigen::Vector3d direction = random.normal3().normalized();
  return {random_estimate(seed), (0.5 + 4.5 * random.uniform()) * direction,
          random_vector(random, 3.0)};
}

/// What an errorless receiver reports at an antenna of this state.
GnssFix perfect_fix(const Estimate& truth, const Setup& s, bool position, bool velocity) {
  GnssFix fix;
  fix.time = truth.nav.time;
  if (position) fix.position = GnssPosition{antenna_position_e(truth, s.lever_b_m)};
  if (velocity) {
    fix.velocity = GnssVelocity{antenna_velocity_e(truth, s.lever_b_m, s.omega_b_radps)};
  }
  return fix;
}

constexpr struct {
  bool position;
  bool velocity;
} kParts[]{{true, false}, {false, true}, {true, true}};

}  // namespace

TEST_CASE("H is the derivative of the innovation with respect to the error") {
  const ErrorVector steps = test::jacobian_steps(0.01, 10.0, 1000.0, 1.0, 0.1);
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Setup s = random_setup(seed);
    for (const auto& part : kParts) {
      CAPTURE(seed);
      CAPTURE(part.position);
      CAPTURE(part.velocity);
      const auto measure = [&](const ErrorVector& x) {
        Estimate truth = s.estimate;
        inject(truth, x);
        return gnss_measurement(perfect_fix(truth, s, part.position, part.velocity), s.estimate,
                                s.lever_b_m, s.omega_b_radps);
      };
      const Measurement m = measure(ErrorVector::Zero());
      REQUIRE(m.rows() == 3 * (part.position + part.velocity));
      // Injecting zero renormalizes the quaternion: a rounding of 300 m/s and 6.4e6 m.
      CHECK(m.innovation.cwiseAbs().maxCoeff() < 2e-9);
      for (int row = 0; row < m.rows(); row += 3) {
        const auto innovation = [&](const ErrorVector& x) -> Eigen::Vector3d {
          return measure(x).innovation.segment<3>(row);
        };
        const auto numeric = test::central_jacobian(innovation, steps);
        for (int col = 0; col < kErrorStates; col += 3) {
          CAPTURE(row);
          CAPTURE(col);
          const Eigen::Matrix3d block = m.H.block<3, 3>(row, col);
          // Relative to the block; a position or a speed of ECEF rounds to 1e-9 m, 6e-14 m/s.
          CHECK(near(numeric.middleCols<3>(col), block, 1e-6 * block.norm()));
        }
      }
    }
  }
}

TEST_CASE("R and the innovation are those of the fix, position first") {
  const Setup s = random_setup(1);
  GnssFix fix = perfect_fix(s.estimate, s, true, true);
  const Eigen::Matrix3d A = Eigen::Matrix3d::Random();
  fix.position->R_e_m2 = A * A.transpose();
  fix.velocity->R_e_m2ps2 = 2.0 * A.transpose() * A;
  fix.position->r_e_m.x() += 7.0;
  fix.velocity->v_e_mps.z() -= 3.0;
  const Measurement m = gnss_measurement(fix, s.estimate, s.lever_b_m, s.omega_b_radps);
  CHECK(m.R.topLeftCorner<3, 3>() == fix.position->R_e_m2);
  CHECK(m.R.bottomRightCorner<3, 3>() == fix.velocity->R_e_m2ps2);
  CHECK(m.R.topRightCorner<3, 3>().isZero(0.0));
  CHECK(m.R.bottomLeftCorner<3, 3>().isZero(0.0));
  Eigen::Matrix<double, 6, 1> expected = Eigen::Matrix<double, 6, 1>::Zero();
  expected(0) = 7.0;
  expected(5) = -3.0;
  CHECK(near(m.innovation, expected, 2e-9));  // ECEF rounding
}

TEST_CASE("a position counts by the time since the one that was fused before it") {
  PositionWeight weight(20.0);
  CHECK(weight.of(time_from_seconds(5.0)) == 1.0);
  weight.fused(time_from_seconds(5.0));
  CHECK(weight.of(time_from_seconds(5.0)) == 0.0);
  CHECK(weight.of(time_from_seconds(15.0)) == gnss_position_weight(10.0, 20.0));
  // What was asked about and not fused does not count.
  CHECK(weight.of(time_from_seconds(25.0)) == gnss_position_weight(20.0, 20.0));
  PositionWeight of_white(0.0);
  of_white.fused(time_from_seconds(5.0));
  CHECK(of_white.of(time_from_seconds(5.1)) == 1.0);
}

TEST_CASE("the antenna moves as the trajectory carries it") {
  const sim::Trajectory trajectory = sim::manoeuvre_car();
  const Eigen::Vector3d lever_b_m(1.0, -2.0, -1.5);
  const auto estimate_at = [&](double t_s) {
    Estimate e;
    e.nav = sim::truth_at(trajectory, t_s).nav;
    e.bias.b_g_radps = {0.01, 0.02, -0.03};
    return e;
  };
  const auto antenna = [&](double t_s) { return antenna_position_e(estimate_at(t_s), lever_b_m); };
  for (double t_s = 5.0; t_s < 95.0; t_s += 7.0) {
    CAPTURE(t_s);
    const double h = 0.005;
    const Eigen::Vector3d numeric_mps = (8.0 * (antenna(t_s + h) - antenna(t_s - h)) -
                                         (antenna(t_s + 2 * h) - antenna(t_s - 2 * h))) /
                                        (12.0 * h);
    const Estimate e = estimate_at(t_s);
    const Eigen::Vector3d measured =
        sim::truth_at(trajectory, t_s).omega_ib_b_radps + e.bias.b_g_radps;
    // ECEF rounding of 1e-9 m over 0.005 s; the stencil leaves h^4 w^5 A / 30 of a 2 Hz motion.
    CHECK(near(antenna_velocity_e(e, lever_b_m, measured), numeric_mps, 1e-6));
  }
}

}  // namespace leeway
