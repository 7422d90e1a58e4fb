#include "leeway/covariance/transition.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "tests/filters/covariance/carried.hpp"
#include "tests/filters/model/random_state.hpp"
#include "tests/support/near.hpp"
#include "tests/support/numbers.hpp"

namespace leeway {
namespace {

using test::accumulated;
using test::carry;
using test::near;
using test::random_estimate;
using test::random_vector;

using test::kInf;
constexpr double kTauA = 5.0;
constexpr double kTauG = 8.0;

/// d (error at the end) / d (error at the start) through the nonlinear model.
ErrorMatrix numeric_transition(const Estimate& start, const std::vector<ImuIncrement>& measured,
                               double tau_a_s = kInf, double tau_g_s = kInf) {
  Estimate end = start;
  carry(end, measured, tau_a_s, tau_g_s);
  const auto error_at_end = [&](const ErrorVector& x) {
    Estimate truth = start;
    inject(truth, x);
    carry(truth, measured, tau_a_s, tau_g_s);
    return difference(truth, end);
  };
  return test::central_jacobian(error_at_end, test::jacobian_steps(0.01, 100.0, 1e4, 1.0, 0.01));
}

std::vector<ImuIncrement> constant_motion(Time from, const Eigen::Vector3d& omega_b_radps,
                                          const Eigen::Vector3d& f_b_mps2, double dt_s, int count) {
  std::vector<ImuIncrement> increments;
  for (int k = 1; k <= count; ++k) {
    increments.push_back(
        {from + k * duration_from_seconds(dt_s), dt_s, dt_s * omega_b_radps, dt_s * f_b_mps2});
  }
  return increments;
}

ErrorDynamics random_dynamics(std::uint64_t seed, double dt_s = 0.01) {
  sim::Random random(seed, 3);
  const Estimate e = random_estimate(seed);
  ErrorDynamics d;
  d.dt_s = dt_s;
  d.C_eb_mean = e.nav.q_eb.toRotationMatrix();
  d.dv_f_e_mps = d.dt_s * random_vector(random, 50.0);
  d.gravity_gradient_e = gravity_gradient_e(e.nav.r_e_m);
  d.a_a = bias_decay(dt_s, kTauA);
  d.g_g = bias_decay(dt_s, kTauG);
  return d;
}

/// Largest error of the 15 x 15 in units of the norm of each 3 x 3 block. The blocks that are zero
/// in `expected` are left to the caller.
double worst_block(const ErrorMatrix& actual, const ErrorMatrix& expected) {
  double worst = 0.0;
  for (int i = 0; i < kErrorStates; i += 3) {
    for (int j = 0; j < kErrorStates; j += 3) {
      const double norm = expected.block<3, 3>(i, j).norm();
      if (norm == 0.0) continue;
      const double error = (actual - expected).block<3, 3>(i, j).norm() / norm;
      worst = std::max(worst, error);
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("F is the derivative of the nonlinear strapdown, block by block") {
  constexpr double kStepS = 0.01;
  // The derivative at 0 from the values at 0 to 5 steps; leaves (w step)^5 / 6 = 4e-9 at 3 rad/s.
  constexpr std::array kForward{-137.0 / 60.0, 5.0, -5.0, 10.0 / 3.0, -1.25, 0.2};
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed, 4);
    const Estimate start = random_estimate(seed);
    // 25 to 50 m/s^2: the relative bound wants a force that is there.
    const Eigen::Vector3d f_b_mps2 =
        25.0 * (1.0 + random.uniform()) * random.normal3().normalized();
    const Eigen::Vector3d omega_b_radps = random_vector(random, 3.0);
    ErrorMatrix numeric = kForward[0] * ErrorMatrix::Identity();
    for (int k = 1; k <= 5; ++k) {
      const auto motion = constant_motion(start.nav.time, omega_b_radps + start.bias.b_g_radps,
                                          f_b_mps2 + start.bias.b_a_mps2, 0.5 * kStepS, 2 * k);
      numeric +=
          kForward[static_cast<std::size_t>(k)] * numeric_transition(start, motion, kTauA, kTauG);
    }
    numeric /= kStepS;
    const Eigen::Matrix3d C_eb = start.nav.q_eb.toRotationMatrix();
    const ErrorMatrix F =
        system_matrix(C_eb, C_eb * f_b_mps2, gravity_gradient_e(start.nav.r_e_m), kTauA, kTauG);
    CHECK(worst_block(numeric, F) < 1e-6);
    // The zero blocks, within the truncation, f (w step)^4 / step of the velocity, and the rounding
    // of six states, 1e-15 rad, 3e-13 m/s and 1e-8 m over the steps of numeric_transition.
    const ErrorVector rounding = test::jacobian_steps(1e-15, 3e-13, 1e-8, 1e-15, 1e-15) / kStepS;
    const ErrorVector steps = test::jacobian_steps(0.01, 100.0, 1e4, 1.0, 0.01);
    for (int i = 0; i < kErrorStates; ++i) {
      for (int j = 0; j < kErrorStates; ++j) {
        CAPTURE(i);
        CAPTURE(j);
        if (F.block<3, 3>(i / 3 * 3, j / 3 * 3).isZero(0.0)) {
          CHECK(near(numeric(i, j), 0.0, 1e-6 + 10.0 * rounding(i) / steps(j)));
        }
      }
    }
  }
}

TEST_CASE("one step is F to second order") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    const ErrorDynamics second_long = random_dynamics(seed, 1.0);
    const ErrorMatrix F = system_matrix(second_long.C_eb_mean, second_long.dv_f_e_mps,
                                        second_long.gravity_gradient_e, kTauA, kTauG);
    // I + F dt + (F dt)^2 / 2: what is left shrinks as dt^3, eightfold by halving.
    const auto error = [&](double dt_s) {
      Transition Phi;
      advance(Phi, random_dynamics(seed, dt_s));
      const ErrorMatrix Fdt = dt_s * F;
      const ErrorMatrix second = ErrorMatrix::Identity() + Fdt + 0.5 * Fdt * Fdt;
      return (dense(Phi) - second).norm();
    };
    CHECK(error(0.5) > 7.5 * error(0.25));
    CHECK(error(0.25) > 7.5 * error(0.125));
  }
}

TEST_CASE("accumulated Phi is the product of its steps") {
  Transition Phi;
  ErrorMatrix product = ErrorMatrix::Identity();
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const ErrorDynamics d = random_dynamics(seed);
    Transition step;
    advance(step, d);
    product = (dense(step) * product).eval();
    advance(Phi, d);
  }
  CHECK(near(Phi.dt_s, 0.5, 1e-12));
  CHECK(worst_block(dense(Phi), product) < 1e-13);  // 50 steps of rounding
  CHECK((dense(Phi).array() == 0.0).cwiseEqual(product.array() == 0.0).all());
}

TEST_CASE("compose is the product of the dense matrices") {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CAPTURE(seed);
    // Two long and different transitions, so that no block is close to zero or to the identity.
    const auto spread = [](std::uint64_t first) {
      Transition Phi;
      for (std::uint64_t k = 0; k < 5; ++k) {
        advance(Phi, random_dynamics(first + k, 20.0));
      }
      return Phi;
    };
    const Transition earlier = spread(100 * seed);
    const Transition later = spread(100 * seed + 50);
    const Transition both = compose(later, earlier);
    CHECK(near(both.dt_s, 200.0, 1e-12));
    const ErrorMatrix product = dense(later) * dense(earlier);
    CHECK(worst_block(dense(both), product) < 1e-14);  // rounding of a sum of 15 products
    CHECK((dense(both).array() == 0.0).cwiseEqual(product.array() == 0.0).all());
  }
}

TEST_CASE("Phi of a manoeuvre against the nonlinear strapdown, with an error that falls as dt^2") {
  const sim::Trajectory trajectory = sim::manoeuvre_car();
  Estimate start;
  start.nav = sim::truth_at(trajectory, 0.0).nav;
  const double duration_s = 1.0;
  const ErrorMatrix numeric =
      numeric_transition(start, sim::true_increments(trajectory, 800.0, duration_s));
  const auto error = [&](double rate_hz) {
    return worst_block(
        dense(accumulated(start.nav, sim::true_increments(trajectory, rate_hz, duration_s))),
        numeric);
  };
  const double at_50_hz = error(50.0);
  const double at_100_hz = error(100.0);
  const double at_200_hz = error(200.0);
  MESSAGE("worst block, relative: " << at_50_hz << " " << at_100_hz << " " << at_200_hz);
  CHECK(at_100_hz < 1e-4);
  CHECK(at_50_hz > 3.5 * at_100_hz);
  CHECK(at_100_hz > 3.5 * at_200_hz);
}

TEST_CASE("a transition frozen at the fix overstates a bias on a circle; advance does not") {
  // 20 m/s on a circle of 50 m: w = 0.4 rad/s. A forward bias b moves the position by
  // b / w^2 |exp(i w t) - 1 - i w t|, frozen by b t^2 / 2.
  const double omega_radps = 0.4;
  const sim::Trajectory trajectory = sim::circle({.radius_m = 50.0, .speed_mps = 20.0});
  Estimate start;
  start.nav = sim::truth_at(trajectory, 0.0).nav;
  struct Case {
    double duration_s;
    double overstated;
  };
  for (const Case& c : {Case{10.0, 1.6}, Case{60.0, 12.0}}) {
    CAPTURE(c.duration_s);
    const auto increments = sim::true_increments(trajectory, 100.0, c.duration_s);
    const Transition Phi = accumulated(start.nav, increments);
    Transition frozen;
    ErrorDynamics d;
    d.dt_s = increments[0].dt_s;
    d.C_eb_mean = start.nav.q_eb.toRotationMatrix();
    d.dv_f_e_mps = d.C_eb_mean * increments[0].dv_b_mps;
    d.gravity_gradient_e = gravity_gradient_e(start.nav.r_e_m);
    for (std::size_t k = 0; k < increments.size(); ++k) advance(frozen, d);

    const double right_m = Phi.r.col(kBa).norm();
    const double angle = omega_radps * c.duration_s;
    const double closed_m =
        std::hypot(std::cos(angle) - 1.0, std::sin(angle) - angle) / (omega_radps * omega_radps);
    // The closed form knows neither gravity gradient nor Coriolis: (t / 800 s)^2 of it at most.
    CHECK(near(right_m / closed_m, 1.0, 0.01));
    CHECK(near(frozen.r.col(kBa).norm() / right_m, c.overstated, 0.04 * c.overstated));

    const auto fine = sim::true_increments(trajectory, 200.0, c.duration_s);
    Estimate unbiased = start;
    Estimate biased = start;
    biased.bias.b_a_mps2.x() = 0.01;
    carry(unbiased, fine, kInf, kInf);
    carry(biased, fine, kInf, kInf);
    const Eigen::Vector3d moved_m = biased.nav.r_e_m - unbiased.nav.r_e_m;
    CHECK(near(moved_m, 0.01 * Phi.r.col(kBa), 1e-5 * moved_m.norm()));
  }
}

}  // namespace leeway
