#include "leeway/model/horizontal.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/earth/units.hpp"
#include "leeway/sim/tools/random.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;

constexpr std::array kShares{0.5, 0.6827, 0.9, 0.95, 0.99, 0.9999};
constexpr std::array kAxisRatios{1.0,  1.001, 1.5, 2.0, 3.0, 5.0, 8.0, 12.0,
                                 20.0, 50.0,  1e2, 1e3, 1e4, 1e6, 1e8};

/// A covariance of the given 1-sigma semi-axes, the longer at an angle from north.
Eigen::Matrix2d ellipse(double major_m, double minor_m, double angle_rad = 0.0) {
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(angle_rad).toRotationMatrix();
  return R * Eigen::Vector2d(major_m * major_m, minor_m * minor_m).asDiagonal() * R.transpose();
}

/// P(|error| < r), integrated over the longer axis: for an x there the other component is within
/// +-sqrt(r^2 - x^2), a difference of error functions. With x = r sin(u) the integrand is smooth;
/// Simpson's rule then errs by less than the rounding of its sum, 1e-14.
double probability_within(double major_m, double minor_m, double r) {
  constexpr int kPanels = 40'000;
  const double h = 0.5 * std::numbers::pi / kPanels;
  double sum = 0.0;
  for (int i = 0; i <= kPanels; ++i) {
    const double u = i * h;
    const double x = r * std::sin(u) / major_m;
    const double y = r * std::cos(u) / minor_m;
    const double value = std::exp(-0.5 * x * x) * std::erf(y / std::numbers::sqrt2) * std::cos(u);
    sum += value * (i == 0 || i == kPanels ? 1.0 : i % 2 == 1 ? 4.0 : 2.0);
  }
  return 2.0 * r / (major_m * std::sqrt(2.0 * std::numbers::pi)) * sum * h / 3.0;
}

}  // namespace

TEST_CASE("radius: a circular error is Rayleigh distributed") {
  for (const double sigma_m : {1e-3, 1.0, 4e5}) {
    for (const double p : kShares) {
      CAPTURE(p);
      const double expected_m = sigma_m * std::sqrt(-2.0 * std::log1p(-p));
      CHECK(
          near(horizontal_radius_m(ellipse(sigma_m, sigma_m), p), expected_m, 1e-12 * expected_m));
    }
  }
}

TEST_CASE("radius: an error along one line is normal") {
  for (const double p : kShares) {
    CAPTURE(p);
    const double r = horizontal_radius_m(ellipse(1.0, 0.0, 0.7), p);
    // dp = pdf dr: the probability of the radius found, within 1e-9 of the radius.
    const double pdf = std::sqrt(2.0 / std::numbers::pi) * std::exp(-0.5 * r * r);
    CHECK(near(std::erf(r / std::numbers::sqrt2), p, 1e-9 * r * pdf + 1e-15));
  }
  // Abramowitz and Stegun, table 26.5: the normal quantile of 0.975, to nine digits.
  CHECK(near(horizontal_radius_m(ellipse(2.0, 0.0), 0.95), 2.0 * 1.959963985, 2e-9));
}

TEST_CASE("radius: any ellipse against an independent integration, to 1e-9" *
          doctest::test_suite("heavy")) {
  double worst = 0.0;
  for (const double ratio : kAxisRatios) {
    for (const double p : kShares) {
      CAPTURE(ratio);
      CAPTURE(p);
      const double r = horizontal_radius_m(ellipse(1.0, 1.0 / ratio, 0.4), p);
      const double step = 1e-4 * r;
      const double pdf = (probability_within(1.0, 1.0 / ratio, r + step) -
                          probability_within(1.0, 1.0 / ratio, r - step)) /
                         (2.0 * step);
      const double error = (probability_within(1.0, 1.0 / ratio, r) - p) / (pdf * r);
      worst = std::max(worst, std::abs(error));
      CHECK(std::abs(error) < 1e-9);
    }
  }
  MESSAGE("worst relative error of a radius: " << worst);
}

TEST_CASE("radius: counted, of half a million errors for each of seeds 1 to 3") {
  constexpr int kErrors = 500'000;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    sim::Random random(seed);
    const Eigen::Rotation2Dd turn(1.1);
    const double r = horizontal_radius_m(ellipse(3.0, 1.0, 1.1), 0.95);
    int within = 0;
    for (int k = 0; k < kErrors; ++k) {
      const double along_m = 3.0 * random.normal();
      within += (turn * Eigen::Vector2d(along_m, random.normal())).norm() < r ? 1 : 0;
    }
    // Four standard deviations of the count.
    CHECK(near(within, 0.95 * kErrors, 4.0 * std::sqrt(0.95 * 0.05 * kErrors)));
  }
}

TEST_CASE("radius and the probability beyond it are inverse to each other") {
  for (const double ratio : kAxisRatios) {
    for (const double p : kShares) {
      CAPTURE(ratio);
      CAPTURE(p);
      const Eigen::Matrix2d P = ellipse(7.0, 7.0 / ratio, 2.0);
      const double r = horizontal_radius_m(P, p);
      CHECK(near(probability_beyond(P, r) / (1.0 - p), 1.0, 1e-9));
    }
  }
  CHECK(near(probability_beyond(ellipse(2.0, 2.0), 3.0), std::exp(-9.0 / 8.0), 1e-15));
  CHECK(probability_beyond(ellipse(2.0, 1.0), 0.0) == 1.0);
  CHECK(probability_beyond(Eigen::Matrix2d::Zero(), 1.0) == 0.0);
}

TEST_CASE("radius does not depend on the direction and scales with the error") {
  for (const double ratio : {1.0, 4.0, 1e4}) {
    const double r = horizontal_radius_m(ellipse(1.0, 1.0 / ratio), 0.95);
    for (int k = 1; k < 12; ++k) {
      CAPTURE(k);
      // The rounding of the turned covariance, 1e-16 of the larger variance.
      CHECK(near(horizontal_radius_m(ellipse(1.0, 1.0 / ratio, 0.5 * k), 0.95), r, 1e-14));
    }
    CHECK(near(horizontal_radius_m(1e10 * ellipse(1.0, 1.0 / ratio), 0.95), 1e5 * r, 1e-7));
  }
}

TEST_CASE("horizontal covariance is the north-east part of a covariance turned into place") {
  // Far from the axes; there the columns of a turn by longitude about z and by -latitude - 90 deg
  // about y are north, east and down.
  for (const double lat_deg : {-89.9, -33.0, 0.0, 45.0, 89.9}) {
    for (const double lon_deg : {-170.0, 0.0, 37.6, 180.0}) {
      CAPTURE(lat_deg);
      CAPTURE(lon_deg);
      const Geodetic place{lat_deg * kRadPerDeg, lon_deg * kRadPerDeg, 120.0};
      const Eigen::Matrix3d C_en =
          (Eigen::AngleAxisd(place.lon_rad, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(-place.lat_rad - 0.5 * std::numbers::pi, Eigen::Vector3d::UnitY()))
              .toRotationMatrix();
      Eigen::Matrix3d P_n_m2;
      P_n_m2 << 4.0, 1.0, -0.5,  //
          1.0, 9.0, 2.0,         //
          -0.5, 2.0, 25.0;
      const Eigen::Matrix2d P_ne_m2 =
          horizontal_covariance(ecef_from_geodetic(place), C_en * P_n_m2 * C_en.transpose());
      // Rounding; near the poles an ECEF position tells the longitude to 1e-9 m / 11 km.
      CHECK(near(P_ne_m2, P_n_m2.topLeftCorner<2, 2>(), 1e-11));
    }
  }
}

}  // namespace leeway
