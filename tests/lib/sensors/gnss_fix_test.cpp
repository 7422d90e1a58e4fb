#include "leeway/sensors/gnss_fix.hpp"

#include <doctest/doctest.h>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "tests/support/near.hpp"
#include "tests/support/numbers.hpp"

namespace leeway {
namespace {

using test::near;

using test::kInf;
using test::kNan;

const Geodetic kPlace{0.977, 1.62, 150.0};

GnssFix good_fix() {
  GnssFix fix;
  fix.position =
      GnssPosition::from_geodetic(kPlace, Eigen::Vector3d(6.25, 6.25, 12.25).asDiagonal());
  fix.velocity = GnssVelocity::from_ned(kPlace, {10.0, -5.0, 0.1},
                                        Eigen::Vector3d(0.01, 0.01, 0.04).asDiagonal());
  return fix;
}

}  // namespace

TEST_CASE("north-east-down covariances turn into Earth-fixed axes") {
  // At 0 deg N, 90 deg E: north is e_z, east is -e_x, down is -e_y.
  const Geodetic place{0.0, 90.0 * kRadPerDeg, 0.0};
  Eigen::Matrix3d R_n;
  R_n << 4.0, 0.5, -0.3, 0.5, 9.0, 0.7, -0.3, 0.7, 16.0;
  Eigen::Matrix3d R_e;
  R_e << 9.0, 0.7, -0.5, 0.7, 16.0, 0.3, -0.5, 0.3, 4.0;
  const GnssPosition position = GnssPosition::from_geodetic(place, R_n);
  CHECK(near(position.r_e_m, Eigen::Vector3d(0.0, 6378137.0, 0.0), 2e-9));
  CHECK(near(position.R_e_m2, R_e, 1e-14));  // m^2: 3 ulp of 16
  const GnssVelocity velocity = GnssVelocity::from_ned(place, {1.0, 2.0, 3.0}, R_n);
  CHECK(near(velocity.v_e_mps, Eigen::Vector3d(-2.0, -3.0, 1.0), 2e-15));
  CHECK(near(velocity.R_e_m2ps2, R_e, 1e-14));
}

TEST_CASE("the variance along a direction survives the turn at any place") {
  Eigen::Matrix3d R_n;
  R_n << 4.0, 0.5, -0.3, 0.5, 9.0, 0.7, -0.3, 0.7, 16.0;
  const Eigen::Matrix3d C_en = ned_to_ecef(kPlace);
  const Eigen::Matrix3d R_e = GnssPosition::from_geodetic(kPlace, R_n).R_e_m2;
  for (int i = 0; i < 3; ++i) {
    CHECK(near(C_en.col(i).dot(R_e * C_en.col(i)), R_n(i, i), 2e-14));  // m^2: 6 ulp of 16
  }
}

TEST_CASE("a fix with either part is usable, one with none is not") {
  CHECK(is_usable(good_fix()));
  GnssFix fix = good_fix();
  fix.velocity.reset();
  CHECK(is_usable(fix));
  fix = good_fix();
  fix.position.reset();
  CHECK(is_usable(fix));
  CHECK_FALSE(is_usable(GnssFix{}));
}

TEST_CASE("one bad number makes the fix unusable") {
  for (const double bad : {kNan, kInf, -kInf}) {
    CAPTURE(bad);
    for (int i = 0; i < 3; ++i) {
      CAPTURE(i);
      GnssFix fix = good_fix();
      fix.position->r_e_m[i] = bad;
      CHECK_FALSE(is_usable(fix));
      fix = good_fix();
      fix.velocity->v_e_mps[i] = bad;
      CHECK_FALSE(is_usable(fix));
      for (int j = 0; j < 3; ++j) {
        fix = good_fix();
        fix.position->R_e_m2(i, j) = fix.position->R_e_m2(j, i) = bad;
        CHECK_FALSE(is_usable(fix));
        fix = good_fix();
        fix.velocity->R_e_m2ps2(i, j) = fix.velocity->R_e_m2ps2(j, i) = bad;
        CHECK_FALSE(is_usable(fix));
      }
    }
  }
}

TEST_CASE("a covariance must be symmetric and positive definite") {
  const auto usable_with = [](const Eigen::Matrix3d& R) {
    GnssFix position = good_fix();
    position.position->R_e_m2 = R;
    GnssFix velocity = good_fix();
    velocity.velocity->R_e_m2ps2 = R;
    CHECK(is_usable(position) == is_usable(velocity));
    return is_usable(position);
  };
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  CHECK(usable_with(R));
  CHECK(usable_with(1e-12 * R));
  CHECK_FALSE(usable_with(1e-200 * R));  // its inverse, squared, is infinite
  CHECK_FALSE(usable_with(Eigen::Matrix3d::Zero()));
  CHECK_FALSE(usable_with(-R));
  R(2, 2) = -1.0;
  CHECK_FALSE(usable_with(R));
  R = Eigen::Matrix3d::Identity();
  R(0, 1) = R(1, 0) = 1.1;  // correlation above one
  CHECK_FALSE(usable_with(R));
  R(0, 1) = R(1, 0) = 0.9;
  CHECK(usable_with(R));
  R(0, 1) = 0.8;
  CHECK_FALSE(usable_with(R));
}

TEST_CASE("a position off the Earth and an absurd speed are unusable") {
  const auto usable_at = [](double radius_m) {
    GnssFix fix = good_fix();
    fix.position->r_e_m = radius_m * Eigen::Vector3d(0.6, 0.64, 0.48);
    return is_usable(fix);
  };
  CHECK(usable_at(6371e3));
  CHECK_FALSE(usable_at(0.0));
  CHECK_FALSE(usable_at(6200e3));
  CHECK_FALSE(usable_at(6500e3));
  CHECK_FALSE(usable_at(1e300));  // its square overflows
  GnssFix fix = good_fix();
  fix.velocity->v_e_mps = {0.0, 2e4, 0.0};
  CHECK_FALSE(is_usable(fix));
}

TEST_CASE("fixes agree when the way between them is what their velocities say") {
  GnssFix earlier = good_fix();
  earlier.time = time_from_seconds(100.0);
  const Eigen::Vector3d v_e_mps = earlier.velocity->v_e_mps;
  const auto later = [&](double dt_s, const Eigen::Vector3d& off_e_m) {
    GnssFix fix = earlier;
    fix.time += duration_from_seconds(dt_s);
    fix.position->r_e_m += dt_s * v_e_mps + off_e_m;
    return fix;
  };
  CHECK(agree(earlier, later(1.0, Eigen::Vector3d::Zero())));
  // Two positions of 2.5 m horizontally and 3.5 m vertically: 4 sigma of the difference at worst is
  // 4 sqrt(2) 3.5 = 20 m, at best 14 m.
  CHECK(agree(earlier, later(1.0, {5.0, 0.0, 0.0})));
  CHECK_FALSE(agree(earlier, later(1.0, {21.0, 0.0, 0.0})));
  CHECK_FALSE(agree(earlier, later(0.0, Eigen::Vector3d::Zero())));
  CHECK_FALSE(agree(earlier, later(5.1, Eigen::Vector3d::Zero())));
  GnssFix position_only = later(1.0, Eigen::Vector3d::Zero());
  position_only.velocity.reset();
  CHECK_FALSE(agree(earlier, position_only));
  // A velocity in km/h: 2.6 times too much of 11.2 m/s is more than 14 m.
  GnssFix fast_before = earlier;
  GnssFix fast = later(1.0, Eigen::Vector3d::Zero());
  fast_before.velocity->v_e_mps *= 3.6;
  fast.velocity->v_e_mps *= 3.6;
  CHECK_FALSE(agree(fast_before, fast));
}

}  // namespace leeway
