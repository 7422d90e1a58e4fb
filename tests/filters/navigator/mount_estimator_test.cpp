#include "leeway/navigator/mount_estimator.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <string>

#include "leeway/model/initial_covariance.hpp"
#include "tests/filters/navigator/car.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

NavigatorConfig unknown_mount() {
  NavigatorConfig config;
  config.C_bs.reset();
  config.vehicle = VehicleConfig::car();
  config.vehicle.rear_axle_x_m = 0.0;
  return config;
}

double angle_rad(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return log_quaternion(Eigen::Quaterniond(Eigen::Matrix3d(a.transpose() * b))).norm();
}

/// Sensor axes by roll, pitch, yaw of the sensor in the vehicle.
struct Mount {
  const char* name;
  EulerAngles deg;
};

constexpr Mount kMounts[]{
    {"as assumed", {0.0, 0.0, 0.0}},    {"turned left", {0.0, 0.0, -90.0}},
    {"backwards", {0.0, 0.0, 180.0}},   {"upside down", {180.0, 0.0, 0.0}},
    {"on its nose", {0.0, -90.0, 0.0}}, {"on its side", {90.0, 0.0, 0.0}},
    {"askew", {25.0, -40.0, 110.0}},
};

}  // namespace

TEST_CASE("a mount that nobody told is found on the drive, and the heading with it" *
          doctest::test_suite("heavy")) {
  double sum_rad2 = 0.0;
  int runs = 0;
  for (const Mount& mount : kMounts) {
    const EulerAngles rad{mount.deg.roll_rad * kRadPerDeg, mount.deg.pitch_rad * kRadPerDeg,
                          mount.deg.yaw_rad * kRadPerDeg};
    const Eigen::Matrix3d C_vs = rotation_from_euler(rad);
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      CAPTURE(std::string(mount.name));
      CAPTURE(seed);
      test::CarOptions options;
      options.C_sv = C_vs.transpose();
      Navigator navigator(unknown_mount());
      CHECK_FALSE(navigator.health().mount_known);
      run(navigator, test::drive(options, seed), 200.0);
      REQUIRE(navigator.aligned());
      REQUIRE(navigator.C_bs());
      CHECK(navigator.health().mount_known);
      const double error_rad = angle_rad(*navigator.C_bs(), C_vs);
      CHECK(error_rad < 2.0 * MountEstimator::kMaxHeadingSigmaRad);
      sum_rad2 += error_rad * error_rad;
      ++runs;
      const NavState& nav = navigator.filter().estimate().nav;
      const NavState truth = sim::truth_at(test::stop_and_go(), to_seconds(nav.time)).nav;
      const double yaw_error_rad = wrap_pi(ned_from_nav_state(nav).attitude.yaw_rad -
                                           ned_from_nav_state(truth).attitude.yaw_rad);
      // As far as the mount may be off, and the heading itself.
      CHECK(std::abs(yaw_error_rad) < 6.0 * kRadPerDeg);
      CHECK(test::horizontal_error_m(navigator) < 5.0);
      CHECK(navigator.health().realignments == 0);
    }
  }
  const double rms_rad = std::sqrt(sum_rad2 / runs);
  MESSAGE("error of the mount, rms of " << runs << " drives: " << rms_rad / kRadPerDeg << " deg");
  CHECK(rms_rad < 3.0 * kRadPerDeg);  // a heading known to 0.1 rad would allow twice that
}

TEST_CASE("a car that only stands or crawls tells nothing of its mount") {
  Navigator navigator(unknown_mount());
  run(navigator, test::drive({}, 1), 17.0);  // 15 s of rest, then below 5 m/s
  CHECK_FALSE(navigator.C_bs());
  CHECK_FALSE(navigator.health().mount_known);
}

TEST_CASE("C_bs is a rotation, forward along the way and down with gravity") {
  // One filter on a straight level road, its sensor turned by 30 deg about down.
  const sim::Trajectory straight = sim::straight({.ground_speed_mps = 15.0, .heading_rad = 1.0});
  const Eigen::Matrix3d C_vs = rotation_from_euler({0.0, 0.0, 30.0 * kRadPerDeg});
  MountEstimator mount;
  double t_s = 0.0;
  const auto push_until = [&](double end_s) {
    for (; t_s <= end_s; t_s += 0.5) {
      Estimate estimate = test::truth_estimate(straight, t_s);
      estimate.nav.q_eb = (estimate.nav.q_eb * Eigen::Quaterniond(C_vs)).normalized();
      const ErrorMatrix P =
          initial_covariance(estimate, {0.01, 0.02, 0.1, 1.0}, automotive_mems_model());
      mount.push(HeadingBank(Ekf(EkfConfig{}, estimate, P)));
    }
  };
  push_until(MountEstimator::kEnoughS - 0.5);
  CHECK_FALSE(mount.C_bs());
  push_until(MountEstimator::kEnoughS);
  REQUIRE(mount.C_bs());
  CHECK(test::near(*mount.C_bs() * mount.C_bs()->transpose(), Eigen::Matrix3d::Identity(), 1e-14));
  // The plane of the straight and the Earth's curve: 100 m are 1.6e-5 rad.
  CHECK(angle_rad(*mount.C_bs(), C_vs) < 1e-4);
}

}  // namespace leeway
