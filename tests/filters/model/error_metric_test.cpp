#include "leeway/model/error_metric.hpp"

#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/units.hpp"
#include "leeway/sim/tools/random.hpp"
#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;

constexpr std::array kRadii{ErrorMetric::kR50, ErrorMetric::kR68, ErrorMetric::kR95,
                            ErrorMetric::kR99};

/// North, east, down; the horizontal part of the given 1-sigma semi-axes, the longer at an angle
/// clockwise from north.
Eigen::Matrix3d covariance(double major_m, double minor_m, double angle_rad, double down_m) {
  const Eigen::Matrix3d C =
      Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d sigma_m(major_m, minor_m, down_m);
  return C * sigma_m.cwiseAbs2().asDiagonal() * C.transpose();
}

/// How many of the errors drawn are of the size that the metric says, for a radius or an interval.
double size_of(ErrorMetric metric, const Eigen::Vector3d& error_n_m, double course_rad) {
  const Eigen::Vector3d error_t_m =
      Eigen::AngleAxisd(-course_rad, Eigen::Vector3d::UnitZ()) * error_n_m;
  if (metric == ErrorMetric::kAlong95) return std::abs(error_t_m.x());
  if (metric == ErrorMetric::kCross95) return std::abs(error_t_m.y());
  if (metric == ErrorMetric::kVertical95) return std::abs(error_t_m.z());
  return error_t_m.head<2>().norm();
}

}  // namespace

TEST_CASE("metrics of a known covariance") {
  Eigen::Matrix3d P;
  P << 9.0, 2.0, 1.0,   //
      2.0, 16.0, -3.0,  //
      1.0, -3.0, 144.0;
  const double north_rad = 0.0;
  CHECK(near(error_size_m(ErrorMetric::kDrms, P, north_rad), 5.0, 1e-15));
  CHECK(near(error_size_m(ErrorMetric::k3d, P, north_rad), 13.0, 1e-15));
  // The larger root of (9 - x)(16 - x) = 4.
  CHECK(near(error_size_m(ErrorMetric::kAxis, P, north_rad),
             std::sqrt(12.5 + std::sqrt(3.5 * 3.5 + 4.0)), 1e-15));
  // Abramowitz and Stegun, table 26.5: the normal quantile of 0.975, to nine digits.
  CHECK(near(error_size_m(ErrorMetric::kVertical95, P, north_rad), 12.0 * 1.959963985, 2e-8));
  CHECK(near(error_size_m(ErrorMetric::kAlong95, P, north_rad), 3.0 * 1.959963985, 2e-8));
  CHECK(near(error_size_m(ErrorMetric::kCross95, P, north_rad), 4.0 * 1.959963985, 2e-8));
  for (const ErrorMetric metric : kAll<ErrorMetric>) {
    CAPTURE(name(metric));
    CHECK(error_size_m(metric, Eigen::Matrix3d::Zero(), 1.0) == 0.0);
    CHECK(near(error_size_m(metric, 1e6 * P, 1.0), 1e3 * error_size_m(metric, P, 1.0), 1e-9));
  }
}

TEST_CASE("radii of a circle and of a line in closed form") {
  for (const ErrorMetric metric : kRadii) {
    CAPTURE(name(metric));
    const double p = radius_probability(metric);
    // Rayleigh: 1 - exp(-r^2 / 2).
    const double circle_m = 3.0 * std::sqrt(-2.0 * std::log1p(-p));
    CHECK(near(error_size_m(metric, covariance(3.0, 3.0, 0.0, 9.0), 0.0), circle_m, 1e-11));
    // Normal: erf(r / sqrt(2)), at the radius found.
    const double line = error_size_m(metric, covariance(1.0, 0.0, 0.7, 9.0), 0.0);
    CHECK(near(std::erf(line / std::numbers::sqrt2), p, 1e-9));
  }
  CHECK(near(error_size_m(ErrorMetric::kR95, covariance(1.0, 0.0, 2.0, 9.0), 0.0), kSigmasOf95,
             1e-9));
  CHECK(near(std::erf(kSigmasOf95 / std::numbers::sqrt2), 0.95, 1e-15));
}

TEST_CASE("every share of a metric, counted of 200 000 errors for each of seeds 1 to 3" *
          doctest::test_suite("heavy")) {
  constexpr int kErrors = 200'000;
  constexpr double kCourseRad = 2.3;
  const Eigen::Matrix3d P = covariance(3.0, 1.0, 0.4, 2.0);
  const Eigen::Matrix3d root = P.llt().matrixL();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    CAPTURE(seed);
    std::vector<Eigen::Vector3d> errors_n_m(kErrors);
    sim::Random random(seed);
    for (Eigen::Vector3d& error : errors_n_m) {
      for (int i = 0; i < 3; ++i) error(i) = random.normal();
      error = root * error;
    }
    for (const ErrorMetric metric : kAll<ErrorMetric>) {
      CAPTURE(name(metric));
      const double is_radius = radius_probability(metric);
      const bool is_interval = name(metric).ends_with("95") && is_radius == 0.0;
      if (is_radius == 0.0 && !is_interval) continue;
      const double p = is_interval ? 0.95 : is_radius;
      const double size_m = error_size_m(metric, P, kCourseRad);
      const auto within = std::count_if(errors_n_m.begin(), errors_n_m.end(), [&](const auto& e) {
        return size_of(metric, e, kCourseRad) < size_m;
      });
      // Four standard deviations of the count.
      const double spread = std::sqrt(p * (1.0 - p) * kErrors);
      CHECK(near(static_cast<double>(within), p * kErrors, 4.0 * spread));
    }
  }
}

TEST_CASE("along and across the track turn with the course, the others do not know it") {
  for (int k = 0; k < 24; ++k) {
    CAPTURE(k);
    const double course_rad = k * std::numbers::pi / 12.0;
    // The longer axis along the track, wherever it points.
    const Eigen::Matrix3d P = covariance(5.0, 2.0, course_rad, 3.0);
    CHECK(near(error_size_m(ErrorMetric::kAlong95, P, course_rad), 5.0 * kSigmasOf95, 1e-13));
    CHECK(near(error_size_m(ErrorMetric::kCross95, P, course_rad), 2.0 * kSigmasOf95, 1e-13));
    // Backwards along the same track, and across it.
    const double back_rad = course_rad + std::numbers::pi;
    CHECK(near(error_size_m(ErrorMetric::kAlong95, P, back_rad), 5.0 * kSigmasOf95, 1e-13));
    const double right_rad = course_rad + 0.5 * std::numbers::pi;
    CHECK(near(error_size_m(ErrorMetric::kAlong95, P, right_rad), 2.0 * kSigmasOf95, 1e-13));
    CHECK(near(error_size_m(ErrorMetric::kAxis, P, course_rad), 5.0, 1e-14));
    for (const ErrorMetric metric : kAll<ErrorMetric>) {
      if (asks_for_course(metric)) continue;
      CAPTURE(name(metric));
      CHECK(error_size_m(metric, P, course_rad) == error_size_m(metric, P, 0.0));
      const Eigen::Matrix3d at_north = covariance(5.0, 2.0, 0.0, 3.0);
      CHECK(near(error_size_m(metric, P, 0.0), error_size_m(metric, at_north, 0.0), 1e-12));
    }
  }
}

TEST_CASE("the height counts in two metrics only") {
  const Eigen::Matrix3d P = covariance(5.0, 2.0, 0.3, 3.0);
  const Eigen::Matrix3d higher = covariance(5.0, 2.0, 0.3, 30.0);
  for (const ErrorMetric metric : kAll<ErrorMetric>) {
    CAPTURE(name(metric));
    const bool same = error_size_m(metric, P, 0.1) == error_size_m(metric, higher, 0.1);
    CHECK(same != asks_for_height(metric));
  }
}

TEST_CASE("names: the old ones keep theirs, and every name finds its metric") {
  for (const ErrorMetric metric : kAll<ErrorMetric>)
    CHECK(from_name<ErrorMetric>(name(metric)) == metric);
  CHECK(from_name<ErrorMetric>("drms") == ErrorMetric::kDrms);
  CHECK(from_name<ErrorMetric>("r95") == ErrorMetric::kR95);
  CHECK(from_name<ErrorMetric>("axis") == ErrorMetric::kAxis);
  CHECK(from_name<ErrorMetric>("3d") == ErrorMetric::k3d);
}

TEST_CASE("covariance along north, east and down, and the course of a velocity there") {
  for (const double lat_deg : {-89.0, -33.0, 0.0, 45.0, 89.0}) {
    CAPTURE(lat_deg);
    const Geodetic place{lat_deg * kRadPerDeg, 37.6 * kRadPerDeg, 120.0};
    const Eigen::Matrix3d C_en = ned_to_ecef(place);
    const Eigen::Matrix3d P_n_m2 = covariance(5.0, 2.0, 0.3, 3.0);
    NavState nav;
    nav.r_e_m = ecef_from_geodetic(place);
    // Rounding; near the poles an ECEF position tells the longitude to 1e-9 m / 111 km.
    CHECK(near(ned_covariance(nav.r_e_m, C_en * P_n_m2 * C_en.transpose()), P_n_m2, 1e-12));
    nav.q_eb = Eigen::Quaterniond(C_en) * Eigen::AngleAxisd(-2.0, Eigen::Vector3d::UnitZ());
    for (const double course_rad : {-3.0, -1.0, 0.0, 2.0}) {
      CAPTURE(course_rad);
      const Eigen::Vector3d v_n(std::cos(course_rad), std::sin(course_rad), 0.7);
      nav.v_e_mps = C_en * (20.0 * v_n);
      CHECK(near(course_over_ground_rad(nav), course_rad, 1e-12));
      // Standing, it looks where its nose points.
      nav.v_e_mps = C_en * (0.9 * kStandingMps * v_n);
      CHECK(near(course_over_ground_rad(nav), -2.0, 1e-12));
    }
  }
}

}  // namespace leeway
