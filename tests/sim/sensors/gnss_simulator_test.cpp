#include "leeway/sim/sensors/gnss_simulator.hpp"

#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

using test::is_chi_square_mean;
using test::near;

/// Errors far below rounding: the fix is the truth.
GnssErrorModel exact_model() {
  GnssErrorModel model;
  model.position_sigma_n_m.setConstant(2e-12);
  model.velocity_sigma_n_mps.setConstant(2e-12);
  return model;
}

/// Position error of a fix on the static trajectory, in NED.
Eigen::Vector3d position_error_n(const GnssFix& fix) {
  return ned_to_ecef(kDefaultOrigin).transpose() *
         (fix.position->r_e_m - ecef_from_geodetic(kDefaultOrigin));
}

}  // namespace

TEST_CASE("the antenna is at the end of the lever arm, and its velocity is its derivative") {
  const Trajectory trajectory = manoeuvre_car();
  GnssErrorModel model = exact_model();
  model.lever_arm_b_m = {0.8, -0.3, -1.2};
  GnssSimulator simulator(trajectory, model, Random(1));
  const auto antenna_e_m = [&](double t_s) -> Eigen::Vector3d {
    const NavState nav = truth_at(trajectory, t_s).nav;
    return nav.r_e_m + nav.q_eb * model.lever_arm_b_m;
  };
  const double h_s = 5e-3;
  for (double t_s = 1.0; t_s < 99.0; t_s += 2.3) {
    CAPTURE(t_s);
    const GnssFix fix = simulator.fix_at(t_s);
    CHECK(fix.time == time_from_seconds(t_s));
    CHECK(is_usable(fix));
    CHECK(near(fix.position->r_e_m, antenna_e_m(t_s), 2e-9));  // rounding of 6e6 m
    const Eigen::Vector3d rate = (8.0 * (antenna_e_m(t_s + h_s) - antenna_e_m(t_s - h_s)) -
                                  (antenna_e_m(t_s + 2.0 * h_s) - antenna_e_m(t_s - 2.0 * h_s))) /
                                 (12.0 * h_s);
    // Rounding 9e-10 m over 5 ms; a fifth derivative of 1e4 m/s^5 costs 2e-7.
    CHECK(near(fix.velocity->v_e_mps, rate, 1e-6));
  }
}

TEST_CASE("white errors have their sigma in each axis, and that is what the fix reports") {
  GnssErrorModel model;
  model.position_sigma_n_m = {1.0, 2.0, 3.0};
  model.velocity_sigma_n_mps = {0.1, 0.2, 0.3};
  GnssSimulator simulator(static_trajectory({.duration_s = 1e4}), model, Random(1));
  const Eigen::Matrix3d C_ne = ned_to_ecef(kDefaultOrigin).transpose();
  const int count = 10'000;
  Eigen::Matrix3d position_m2 = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d velocity_m2ps2 = Eigen::Matrix3d::Zero();
  for (int k = 0; k < count; ++k) {
    const GnssFix fix = simulator.fix_at(k);
    const Eigen::Vector3d e = position_error_n(fix).cwiseQuotient(model.position_sigma_n_m);
    const Eigen::Vector3d v =
        (C_ne * fix.velocity->v_e_mps).cwiseQuotient(model.velocity_sigma_n_mps);
    position_m2 += e * e.transpose() / count;
    velocity_m2ps2 += v * v.transpose() / count;
    if (k > 0) continue;
    // Rounding of 9 m^2 turned there and back.
    CHECK(near(C_ne * fix.position->R_e_m2 * C_ne.transpose(),
               Eigen::Vector3d(1.0, 4.0, 9.0).asDiagonal().toDenseMatrix(), 1e-14));
    CHECK(near(C_ne * fix.velocity->R_e_m2ps2 * C_ne.transpose(),
               Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal().toDenseMatrix(), 1e-16));
  }
  // Four standard deviations of a variance; a covariance has less.
  const double bound = 4.0 * std::sqrt(2.0 / count);
  CHECK(near(position_m2, Eigen::Matrix3d::Identity(), bound));
  CHECK(near(velocity_m2ps2, Eigen::Matrix3d::Identity(), bound));
}

TEST_CASE("the correlated error decays exponentially at any interval, its variance stationary") {
  GnssErrorModel model = exact_model();
  model.correlated_sigma_n_m = {2.0, 2.0, 2.0};
  model.correlation_time_s = 30.0;
  const Trajectory trajectory = static_trajectory();
  const int trials = 3000;
  const double n = 3.0 * trials;
  const double times_s[] = {5.0, 6.0, 20.0, 65.0};
  double variance[4]{};
  double product[4]{};  // with the first
  for (std::uint32_t trial = 1; trial <= trials; ++trial) {
    GnssSimulator simulator(trajectory, model, Random(1, trial, kGnssStream));
    Eigen::Vector3d first = Eigen::Vector3d::Zero();
    for (int k = 0; k < 4; ++k) {
      const Eigen::Vector3d e = position_error_n(simulator.fix_at(times_s[k])) / 2.0;
      if (k == 0) first = e;
      variance[k] += e.squaredNorm() / n;
      product[k] += e.dot(first) / n;
    }
  }
  for (int k = 0; k < 4; ++k) {
    CAPTURE(times_s[k]);
    CHECK(is_chi_square_mean(variance[k], 3 * trials));
    const double rho = std::exp(-(times_s[k] - times_s[0]) / 30.0);
    CHECK(near(product[k], rho, 4.0 * std::sqrt((1.0 + rho * rho) / n)));
  }
}

TEST_CASE("the reported covariance covers white and correlated error together") {
  GnssErrorModel model;
  model.correlated_sigma_n_m = {3.0, 1.0, 5.0};
  const Trajectory trajectory = static_trajectory();
  const int trials = 3000;
  double position_nees = 0.0;
  double velocity_nees = 0.0;
  for (std::uint32_t trial = 1; trial <= trials; ++trial) {
    GnssSimulator simulator(trajectory, model, Random(2, trial, kGnssStream));
    simulator.fix_at(0.0);
    const GnssFix fix = simulator.fix_at(40.0);
    const Eigen::Vector3d e = fix.position->r_e_m - ecef_from_geodetic(kDefaultOrigin);
    const Eigen::Vector3d v = fix.velocity->v_e_mps;
    position_nees += e.dot(fix.position->R_e_m2.inverse() * e) / (3.0 * trials);
    velocity_nees += v.dot(fix.velocity->R_e_m2ps2.inverse() * v) / (3.0 * trials);
  }
  CHECK(is_chi_square_mean(position_nees, 3 * trials));
  CHECK(is_chi_square_mean(velocity_nees, 3 * trials));
}

TEST_CASE("an infinite correlation time is a constant offset") {
  GnssErrorModel model = exact_model();
  model.correlated_sigma_n_m = {2.0, 2.0, 2.0};
  model.correlation_time_s = std::numeric_limits<double>::infinity();
  GnssSimulator simulator(static_trajectory(), model, Random(1));
  const Eigen::Vector3d first = position_error_n(simulator.fix_at(0.0));
  CHECK(first.norm() > 0.1);
  CHECK(near(position_error_n(simulator.fix_at(3000.0)), first, 4e-9));
}

TEST_CASE("times must ascend, and a refused time changes nothing") {
  const Trajectory trajectory = static_trajectory();
  GnssSimulator simulator(trajectory, {}, Random(1));
  GnssSimulator undisturbed(trajectory, {}, Random(1));
  simulator.fix_at(10.0);
  undisturbed.fix_at(10.0);
  CHECK_THROWS_AS(simulator.fix_at(10.0), Error);
  CHECK_THROWS_AS(simulator.fix_at(9.0), Error);
  CHECK_THROWS_AS(simulator.fix_at(std::nan("")), Error);
  CHECK(simulator.fix_at(11.0).position->r_e_m == undisturbed.fix_at(11.0).position->r_e_m);
}

TEST_CASE("a model outside its range is refused by name") {
  GnssErrorModel model;
  model.velocity_sigma_n_mps.y() = 0.0;
  CHECK_THROWS_WITH_AS(validate(model),
                       "GNSS simulator: velocity_sigma_n_mps is 0, must be finite and > 0", Error);
  model = {};
  model.position_sigma_n_m.z() = -1.0;
  CHECK_THROWS_AS(validate(model), Error);
  model = {};
  model.position_sigma_n_m.setZero();
  CHECK_THROWS_AS(validate(model), Error);
  model.correlated_sigma_n_m.setOnes();
  CHECK_NOTHROW(validate(model));
  model.correlation_time_s = 0.0;
  CHECK_THROWS_AS(validate(model), Error);
  model = {};
  model.lever_arm_b_m.x() = std::nan("");
  CHECK_THROWS_AS(validate(model), Error);
  CHECK_THROWS_AS(GnssSimulator(Trajectory{}, {}, Random(1)), Error);
}

}  // namespace leeway::sim
