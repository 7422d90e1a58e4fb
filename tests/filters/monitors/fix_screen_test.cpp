#include "leeway/monitors/fix_screen.hpp"

#include <doctest/doctest.h>

#include <cmath>

namespace leeway {
namespace {

using Finding = FixScreen::Finding;

GnssFix fix_of(const Geodetic& place, const Eigen::Vector3d& v_n_mps, double sigma = 1.0) {
  GnssFix fix;
  const Eigen::Matrix3d R = sigma * sigma * Eigen::Matrix3d::Identity();
  fix.position = GnssPosition::from_geodetic(place, R);
  fix.velocity = GnssVelocity::from_ned(place, v_n_mps, R);
  return fix;
}

const Geodetic kHere{0.8, 0.1, 300.0};

TEST_CASE("a fix repeated to the last bit is no news while the vehicle moves") {
  FixScreen screen;
  const GnssFix moving = fix_of(kHere, {5.0, 0.0, 0.0});
  CHECK(screen.judge(moving, false) == Finding::kNews);
  CHECK(screen.judge(moving, false) == Finding::kRepeated);
  const GnssFix frozen = fix_of({0.8, 0.1, 301.0}, {0.0, 0.0, 0.0});
  CHECK(screen.judge(frozen, true) == Finding::kNews);
  CHECK(screen.judge(frozen, true) == Finding::kRepeated);
  CHECK(screen.judge(frozen, false) == Finding::kNews);  // parked: quantized and right
}

TEST_CASE("each half of a fix that was cut in two is looked at alone") {
  FixScreen screen;
  GnssFix position = fix_of(kHere, {5.0, 0.0, 0.0});
  GnssFix velocity = position;
  position.velocity.reset();
  velocity.position.reset();
  CHECK(screen.judge(velocity, true) == Finding::kNews);
  CHECK(screen.judge(position, true) == Finding::kNews);
  CHECK(screen.judge(velocity, true) == Finding::kRepeated);
  CHECK(screen.judge(position, true) == Finding::kRepeated);
}

TEST_CASE("latitude and longitude zero are the word for no position, at any height") {
  FixScreen screen;
  CHECK(screen.judge(fix_of({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}), false) == Finding::kNone);
  CHECK(screen.judge(fix_of({0.0, 0.0, -17.0}, {0.0, 0.0, 0.0}), false) == Finding::kNone);
  CHECK(screen.judge(fix_of({1e-6, 0.0, 0.0}, {0.0, 0.0, 0.0}), false) == Finding::kNews);  // 6 m
}

double position_sigma(const GnssFix& fix) { return std::sqrt(fix.position->R_e_m2(0, 0)); }

TEST_CASE("no sigma is below 1 mm and 1 mm/s; larger ones stay to the bit") {
  const GnssFix tiny = FixScreen().with_floor(fix_of(kHere, {5.0, 0.0, 0.0}, 1e-11));
  CHECK(tiny.position->R_e_m2(0, 0) == doctest::Approx(1e-6));
  CHECK(tiny.velocity->R_e_m2ps2(0, 0) == doctest::Approx(1e-6));
  const GnssFix usual = fix_of(kHere, {5.0, 0.0, 0.0}, 0.5);
  CHECK(FixScreen().with_floor(usual).position->R_e_m2 == usual.position->R_e_m2);
}

TEST_CASE("a claim is believed to improve by a factor of three from fix to fix") {
  const auto believed = [](FixScreen& screen, double claimed_m) {
    return position_sigma(screen.with_floor(fix_of(kHere, {5.0, 0.0, 0.0}, claimed_m)));
  };
  FixScreen screen;
  CHECK(believed(screen, 1.8) == doctest::Approx(1.8));
  // One in ten claims to be perfect: it counts as a good one, and spoils nothing.
  CHECK(believed(screen, 1e-11) == doctest::Approx(0.6));
  CHECK(believed(screen, 1.8) == doctest::Approx(1.8));
  // A receiver that has fixed its ambiguities goes on to say so.
  CHECK(believed(screen, 0.02) == doctest::Approx(1.8 / 3.0 / 1.5).epsilon(0.6));
  for (int k = 0; k < 5; ++k) believed(screen, 0.02);
  CHECK(believed(screen, 0.02) == doctest::Approx(0.02));
  // One bad claim between good ones: the next good one is within a factor of two.
  CHECK(believed(screen, 100.0) == doctest::Approx(100.0));
  CHECK(believed(screen, 0.02) == doctest::Approx(0.02));
}

}  // namespace
}  // namespace leeway
