#include "leeway/earth/earth.hpp"

#include <doctest/doctest.h>

#include <GeographicLib/NormalGravity.hpp>
#include <algorithm>
#include <cmath>

#include "leeway/earth/rotation.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;

/// The closed form in ellipsoidal-harmonic coordinates, centrifugal included.
Eigen::Vector3d exact_gravity_e(const Eigen::Vector3d& r_e_m) {
  Eigen::Vector3d g_e;
  GeographicLib::NormalGravity::WGS84().U(r_e_m.x(), r_e_m.y(), r_e_m.z(), g_e.x(), g_e.y(),
                                          g_e.z());
  return g_e;
}

/// Calls f(r_e_m) all over the globe at a height.
template <class F>
void for_places_at(double height_m, const F& f) {
  for (double lat_deg = -90.0; lat_deg <= 90.0; lat_deg += 2.5) {
    for (const double lon_deg : {-180.0, -71.3, 0.0, 37.6, 92.8}) {
      CAPTURE(lat_deg);
      CAPTURE(lon_deg);
      CAPTURE(height_m);
      f(ecef_from_geodetic({lat_deg * kRadPerDeg, lon_deg * kRadPerDeg, height_m}));
    }
  }
}

/// Largest distance from the exact normal gravity at a height, m/s^2.
double largest_error_mps2(GravityModel model, double height_m) {
  double largest = 0.0;
  for_places_at(height_m, [&](const Eigen::Vector3d& r_e_m) {
    largest = std::max(largest, (gravity_e(model, r_e_m) - exact_gravity_e(r_e_m)).norm());
  });
  return largest;
}

}  // namespace

TEST_CASE("the ellipsoid's axes are where WGS-84 puts them") {
  const double a = 6378137.0;
  const double b = 6356752.314245;  // NGA.STND.0036, table 3.2, to 1 um
  // 2e-9 m: two roundings at 6.4e6 m
  CHECK(near(ecef_from_geodetic({0.0, 0.0, 0.0}), Eigen::Vector3d(a, 0.0, 0.0), 2e-9));
  CHECK(near(ecef_from_geodetic({0.0, 90.0 * kRadPerDeg, 100.0}),
             Eigen::Vector3d(0.0, a + 100.0, 0.0), 2e-9));
  CHECK(near(ecef_from_geodetic({-90.0 * kRadPerDeg, 1.0, 0.0}), Eigen::Vector3d(0.0, 0.0, -b),
             1e-6));
  CHECK(near(wgs84::kSemiMinorAxisM, b, 1e-6));
}

TEST_CASE("ecef_from_geodetic is the textbook formula, Groves (2.112)") {
  for (const double lat_deg : {-89.0, -60.0, 0.5, 45.0, 56.0, 89.9}) {
    for (const double lon_deg : {-179.0, 37.6, 92.8}) {
      const long double lat = static_cast<long double>(lat_deg * kRadPerDeg);
      const long double lon = static_cast<long double>(lon_deg * kRadPerDeg);
      const long double h = 150.0L;
      const long double f = 1.0L / 298.257223563L;
      const long double e2 = f * (2.0L - f);
      const long double N = 6378137.0L / std::sqrt(1.0L - e2 * std::sin(lat) * std::sin(lat));
      const Eigen::Matrix<long double, 3, 1> r((N + h) * std::cos(lat) * std::cos(lon),
                                               (N + h) * std::cos(lat) * std::sin(lon),
                                               ((1.0L - e2) * N + h) * std::sin(lat));
      CAPTURE(lat_deg);
      CAPTURE(lon_deg);
      // The bound of the docstring.
      CHECK(near(ecef_from_geodetic({lat_deg * kRadPerDeg, lon_deg * kRadPerDeg, 150.0}),
                 r.cast<double>(), 2e-9));
    }
  }
}

TEST_CASE("geodetic coordinates come back, poles and antimeridian included") {
  for (const double height_m : {-5000e3, -10e3, 0.0, 150.0, 100e3, 5000e3}) {
    for (const double lat_deg : {-90.0, -89.99999999, -60.0, 0.0, 1e-9, 45.0, 90.0}) {
      for (const double lon_deg : {-180.0, -179.9999999999, -37.6, 0.0, 92.8, 179.9999999999}) {
        CAPTURE(height_m);
        CAPTURE(lat_deg);
        CAPTURE(lon_deg);
        const Geodetic in{lat_deg * kRadPerDeg, lon_deg * kRadPerDeg, height_m};
        const Eigen::Vector3d r_e_m = ecef_from_geodetic(in);
        const Geodetic out = geodetic_from_ecef(r_e_m);
        // m: the docstrings' 2e-9 out and 7e-9 back.
        CHECK(near(out.height_m, in.height_m, 9e-9));
        CHECK(near((out.lat_rad - in.lat_rad) * 6.4e6, 0.0, 6.4e6 / (6.3e6 + height_m) * 9e-9));
        CHECK((ecef_from_geodetic(out) - r_e_m).norm() < 9e-9);
        CHECK(std::abs(out.lon_rad) <= 3.1415926535897932);
      }
    }
  }
}

TEST_CASE("north, east and down are the directions in which the coordinates grow") {
  for (const double lat_deg : {-89.0, -33.0, 0.0, 56.0, 89.9}) {
    for (const double lon_deg : {-179.0, 0.0, 92.8}) {
      const Geodetic at{lat_deg * kRadPerDeg, lon_deg * kRadPerDeg, 150.0};
      const Eigen::Matrix3d C_en = ned_to_ecef(at);
      const auto toward = [&](double d_lat, double d_lon, double d_h) {
        const Geodetic plus{at.lat_rad + d_lat, at.lon_rad + d_lon, at.height_m + d_h};
        const Geodetic minus{at.lat_rad - d_lat, at.lon_rad - d_lon, at.height_m - d_h};
        return (ecef_from_geodetic(plus) - ecef_from_geodetic(minus)).normalized().eval();
      };
      CAPTURE(lat_deg);
      CAPTURE(lon_deg);
      // rad: central differences; 2e-9 m of rounding over at least 20 m.
      CHECK(near(C_en.col(0), toward(1e-5, 0.0, 0.0), 2e-10));
      CHECK(near(C_en.col(1), toward(0.0, 1e-3, 0.0), 2e-10));
      CHECK(near(C_en.col(2), -toward(0.0, 0.0, 1e3), 2e-10));
      CHECK(near(C_en.transpose() * C_en, Eigen::Matrix3d::Identity(), 5e-16));
      CHECK(near(C_en.determinant(), 1.0, 5e-16));
    }
  }
}

TEST_CASE("gravity models stay within their stated bounds of the exact normal gravity") {
  for (const double height_m : {-10e3, -1e3, 0.0, 150.0, 10e3, 100e3, 2000e3}) {
    const double constant = largest_error_mps2(GravityModel::kConstant, height_m);
    const double j2 = largest_error_mps2(GravityModel::kJ2, height_m);
    const double normal = largest_error_mps2(GravityModel::kNormal, height_m);
    MESSAGE("gravity error at " << height_m << " m: constant " << constant << ", J2 " << j2
                                << ", normal " << normal << " m/s^2");
    CAPTURE(height_m);
    if (height_m == 0.0) CHECK(constant < 0.027);
    if (std::abs(height_m) <= 10e3) CHECK(constant < 0.06);
    CHECK(j2 < 1.2e-4);
    CHECK(normal < 1.5e-14);
    // A bound ten times too wide says nothing.
    if (height_m == 0.0) CHECK((constant > 0.02 && j2 > 1e-4));
  }
}

TEST_CASE("constant gravity has its magnitude and the direction of the normal at height 0") {
  for_places_at(0.0, [&](const Eigen::Vector3d& r_e_m) {
    const Eigen::Vector3d g_e = gravity_e<GravityModel::kConstant>(r_e_m);
    const Eigen::Vector3d down = ned_to_ecef(geodetic_from_ecef(r_e_m)).col(2);
    CHECK(near(g_e, kStandardGravityMps2 * down, 1e-14));  // 6 ulp of 9.8
  });
}

TEST_CASE("gravity_gradient_e is the slope of normal gravity") {
  // Fourth-order central differences over 2 km and 4 km: truncation 1e-13 relative ((4 km / r)^4),
  // rounding 1e-15 * 9.8 / (2 km) = 5e-18 1/s^2, 2e-12 of the largest element.
  constexpr double kStepM = 2000.0;
  double worst = 0.0;
  for (const double height_m : {-10e3, 0.0, 10e3, 100e3, 2000e3}) {
    for_places_at(height_m, [&](const Eigen::Vector3d& r_e_m) {
      const Eigen::Matrix3d gradient = gravity_gradient_e(r_e_m);
      Eigen::Matrix3d numeric;
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d d = kStepM * Eigen::Vector3d::Unit(i);
        const auto difference = [&](double n) {
          return (gravity_e<GravityModel::kNormal>(r_e_m + n * d) -
                  gravity_e<GravityModel::kNormal>(r_e_m - n * d))
              .eval();
        };
        numeric.col(i) = (8.0 * difference(1.0) - difference(2.0)) / (12.0 * kStepM);
      }
      const double scale = gradient.cwiseAbs().maxCoeff();
      worst = std::max(worst, test::distance(gradient, numeric) / scale);
      CHECK(near(gradient, numeric, 1e-8 * scale));  // the bound of the docstring
      CHECK(gradient == gradient.transpose());
      // Poisson's equation in empty space. 1/s^2: rounding of a sum of terms of 3e-6.
      const double omega = 7.292115e-5;
      CHECK(near(gradient.trace(), 2.0 * omega * omega, 3e-21));
    });
  }
  MESSAGE("largest relative error of the gravity gradient: " << worst);
}

}  // namespace leeway
