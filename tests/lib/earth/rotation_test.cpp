#include "leeway/earth/rotation.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tests/support/near.hpp"

namespace leeway {
namespace {

using test::near;
using LongMatrix = Eigen::Matrix<long double, 3, 3>;
using LongQuaternion = Eigen::Quaternion<long double>;

// Both sides of every switch from series to closed form: 0.01 and 0.02 rad in sinc (of the angle
// and of its half), 0.04 rad in the versine, 0.5 rad in the Jacobian.
constexpr std::array kAngles{0.0,
                             1e-12,
                             1e-9,
                             1e-4,
                             9.99e-3,
                             1.001e-2,
                             1.999e-2,
                             2.001e-2,
                             0.039,
                             0.041,
                             0.4999,
                             0.5001,
                             1.0,
                             2.5,
                             std::numbers::pi - 1e-9,
                             std::numbers::pi};

const Eigen::Vector3d kAxes[] = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitZ(),
                                 Eigen::Vector3d(2.0, -3.0, 6.0) / 7.0,
                                 Eigen::Vector3d(-8.0, 4.0, 1.0) / 9.0};

LongQuaternion long_exp(const Eigen::Vector3d& phi) {
  const Eigen::Matrix<long double, 3, 1> p = phi.cast<long double>();
  const long double angle = p.norm();
  const long double ratio = angle > 0.0L ? std::sin(angle / 2.0L) / angle : 0.5L;
  return {std::cos(angle / 2.0L), ratio * p.x(), ratio * p.y(), ratio * p.z()};
}

/// Sum of [phi x]^k / (k + shift)!: the exponential for shift 0, the left Jacobian for shift 1.
LongMatrix power_series(const Eigen::Vector3d& phi, int shift) {
  const LongMatrix S = skew(phi).cast<long double>();
  LongMatrix term = LongMatrix::Identity();
  LongMatrix sum = term;
  for (int k = 1; k < 60; ++k) {
    term = term * S / static_cast<long double>(k + shift);
    sum += term;
  }
  return sum;
}

}  // namespace

TEST_CASE("skew makes the cross product") {
  const Eigen::Vector3d a(1.0, -2.0, 3.0);
  const Eigen::Vector3d b(-4.0, 5.0, 7.0);
  CHECK(skew(a) * b == a.cross(b));
}

TEST_CASE("exp_quaternion is the half-angle form, to rounding, at every angle") {
  for (const Eigen::Vector3d& axis : kAxes) {
    for (const double angle : kAngles) {
      CAPTURE(angle);
      const Eigen::Vector3d phi = angle * axis;
      const LongQuaternion exact = long_exp(phi);
      const Eigen::Quaterniond q = exp_quaternion(phi);
      CHECK(near(q.w(), static_cast<double>(exact.w()), 2.3e-16));  // 1 ulp of 1
      // The vector part to 2 ulp of itself, however small.
      CHECK(near(q.vec(), exact.vec().cast<double>(), 4.5e-16 * std::sin(0.5 * angle)));
    }
  }
}

TEST_CASE("log_quaternion inverts exp_quaternion and does not mind the sign of q") {
  for (const Eigen::Vector3d& axis : kAxes) {
    for (const double angle : kAngles) {
      CAPTURE(angle);
      const Eigen::Vector3d phi = angle * axis;
      const Eigen::Quaterniond q = exp_quaternion(phi);
      const Eigen::Quaterniond minus_q(-q.w(), -q.x(), -q.y(), -q.z());
      // 4 ulp of the angle: two roundings each way. At pi either direction is right.
      const double tolerance = 9e-16 * angle;
      if (angle < std::numbers::pi) {
        CHECK(near(log_quaternion(q), phi, tolerance));
        CHECK(near(log_quaternion(minus_q), phi, tolerance));
      } else {
        CHECK(near(log_quaternion(q).norm(), std::numbers::pi, tolerance));
        CHECK(near(log_quaternion(q).cross(phi).norm(), 0.0, 1e-14));
      }
    }
  }
  CHECK(log_quaternion(Eigen::Quaterniond::Identity()) == Eigen::Vector3d::Zero());
  CHECK(near(log_quaternion(exp_quaternion({0.0, 0.0, 4.0})).z(), 4.0 - 2.0 * std::numbers::pi,
             2e-15));
}

TEST_CASE("exp_rotation is the power series of the matrix exponential") {
  for (const Eigen::Vector3d& axis : kAxes) {
    for (const double angle : kAngles) {
      CAPTURE(angle);
      // 4 ulp of 1: a quaternion to a matrix is a sum of three products of rounded factors.
      CHECK(near(exp_rotation(angle * axis), power_series(angle * axis, 0).cast<double>(), 9e-16));
    }
  }
}

TEST_CASE("log_rotation returns the vector of Eigen's angle and axis, close to pi too") {
  for (const Eigen::Vector3d& axis : kAxes) {
    for (const double angle :
         {1e-9, 1e-4, 0.5, 2.0, 3.0, std::numbers::pi - 1e-4, std::numbers::pi - 1e-9}) {
      CAPTURE(angle);
      const Eigen::Matrix3d C = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
      // rad: the elements of C carry 1 ulp, and the angle is read from the larger ones.
      CHECK(near(log_rotation(C), angle * axis, 3e-15));
    }
  }
}

TEST_CASE("left_jacobian is the mean rotation") {
  const Eigen::Vector3d v(3.0, -5.0, 9.8);
  for (const Eigen::Vector3d& axis : kAxes) {
    for (const double angle : kAngles) {
      CAPTURE(angle);
      const Eigen::Vector3d phi = angle * axis;
      const Eigen::Matrix3d J = left_jacobian(phi);
      CHECK(near(J, power_series(phi, 1).cast<double>(), 9e-16));  // 4 ulp of 1
      CHECK(near(left_jacobian_times(phi, v), J * v, 1e-14));      // 4 ulp of |v| = 11.4
    }
  }
}

TEST_CASE("left_jacobian maps a change of the rotation vector to a turn of the frame") {
  // Central differences at 1e-4 rad: truncation h^2 / 6 = 2e-9, rounding 1e-16 / 1e-4 = 1e-12.
  constexpr double kStep = 1e-4;
  for (const double angle : {1e-9, 0.3, 1.7, 3.0}) {
    const Eigen::Vector3d phi = angle * kAxes[2];
    const Eigen::Matrix3d J = left_jacobian(phi);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
      const Eigen::Matrix3d turn = exp_rotation(phi + d) * exp_rotation(phi - d).transpose();
      CAPTURE(angle);
      CHECK(near(log_rotation(turn) / (2.0 * kStep), J.col(i), 2e-9));
    }
  }
}

TEST_CASE("turned composes as long double does") {
  const Eigen::Quaterniond q = exp_quaternion({0.4, -1.1, 2.0});
  for (const double angle : kAngles) {
    CAPTURE(angle);
    const Eigen::Vector3d left = -0.3 * angle * kAxes[3];
    const Eigen::Vector3d right = angle * kAxes[2];
    const LongQuaternion exact =
        long_exp(left) * q.cast<long double>().normalized() * long_exp(right);
    // A handful of ulp of 1 for a large turn.
    CHECK(near(turned(left, q, right).coeffs(), exact.coeffs().cast<double>(), 7e-16));
  }
}

TEST_CASE("a million turned steps leave the random walk of their roundings") {
  const Eigen::Vector3d left(0.0, 0.0, -7.292115e-7);
  const Eigen::Vector3d right(1e-3, -2e-3, 5e-4);
  constexpr int kSteps = 1'000'000;
  const Eigen::Quaterniond start = exp_quaternion({0.4, -1.1, 2.0});
  Eigen::Quaterniond q = start;
  for (int k = 0; k < kSteps; ++k) q = turned(left, q, right);

  // Rotations about one fixed axis on each side compose to their multiples.
  const auto multiple = [](const Eigen::Vector3d& phi) {
    const Eigen::Matrix<long double, 3, 1> p = phi.cast<long double>();
    const long double half = kSteps * p.norm() / 2.0L;
    LongQuaternion turn(std::cos(half), 0.0L, 0.0L, 0.0L);
    turn.vec() = std::sin(half) * p.normalized();
    return turn;
  };
  const LongQuaternion exact =
      multiple(left) * start.cast<long double>().normalized() * multiple(right);
  const double error_rad =
      2.0 * static_cast<double>((q.cast<long double>() * exact.conjugate()).vec().norm());
  MESSAGE("attitude error after 1e6 steps of 2.3 mrad: " << error_rad << " rad");
  // Three sigma of 1e6 steps of 1.6e-16 rad: two additions to components below 1, three axes.
  CHECK(error_rad < 3.0 * 1.6e-16 * std::sqrt(double{kSteps}));
  CHECK(near(q.norm(), 1.0, 4.5e-16));
}

TEST_CASE("rotation_between turns one direction into another by the angle between them") {
  for (const Eigen::Vector3d& from : kAxes) {
    for (const double angle : kAngles) {
      const Eigen::Vector3d across = from.unitOrthogonal();
      const Eigen::Vector3d to = exp_rotation(angle * across) * from;
      const Eigen::Quaterniond q = rotation_between(3.0 * from, 0.5 * to);
      CAPTURE(angle);
      CHECK(near(q.norm(), 1.0, 1e-15));
      CHECK(near(q * from, to, 2e-6));  // half a turn is one from 1.4e-6 rad of it on
      if (angle < 3.0) {
        CHECK(near(q * from, to, 1e-15));
        CHECK(near(log_quaternion(q), angle * across, 1e-14));
      }
    }
    CHECK(near(rotation_between(from, -from) * from, -from, 1e-15));
  }
}

TEST_CASE("Euler angles mean yaw, then pitch, then roll of a forward-right-down body") {
  // Groves (2.22), transposed, element by element.
  const double r = 0.3;
  const double p = -0.7;
  const double y = 2.1;
  Eigen::Matrix3d C;
  C << std::cos(p) * std::cos(y),
      -std::cos(r) * std::sin(y) + std::sin(r) * std::sin(p) * std::cos(y),
      std::sin(r) * std::sin(y) + std::cos(r) * std::sin(p) * std::cos(y),
      std::cos(p) * std::sin(y),
      std::cos(r) * std::cos(y) + std::sin(r) * std::sin(p) * std::sin(y),
      -std::sin(r) * std::cos(y) + std::cos(r) * std::sin(p) * std::sin(y),  //
      -std::sin(p), std::sin(r) * std::cos(p), std::cos(r) * std::cos(p);
  CHECK(near(rotation_from_euler({r, p, y}), C, 5e-16));
  const EulerAngles rpy = euler_from_rotation(C);
  CHECK(near(rpy.roll_rad, r, 5e-16));
  CHECK(near(rpy.pitch_rad, p, 5e-16));
  CHECK(near(rpy.yaw_rad, y, 5e-16));
}

TEST_CASE("Euler angles come back, all round and up to pitch +-90 deg") {
  for (double roll_deg = -179.0; roll_deg <= 180.0; roll_deg += 44.875) {
    for (const double pitch_deg : {-90.0, -89.9999, -89.0, -30.0, 0.0, 60.0, 89.9999, 90.0}) {
      for (double yaw_deg = 0.0; yaw_deg < 360.0; yaw_deg += 40.0) {
        CAPTURE(roll_deg);
        CAPTURE(pitch_deg);
        CAPTURE(yaw_deg);
        const EulerAngles in{roll_deg * kRadPerDeg, pitch_deg * kRadPerDeg, yaw_deg * kRadPerDeg};
        const Eigen::Matrix3d C = rotation_from_euler(in);
        const EulerAngles out = euler_from_rotation(C);
        // rad: roll and yaw lose digits as 1 / cos(pitch), the rotation itself none.
        const double spread = 1e-15 / std::max(std::cos(in.pitch_rad), 1e-8);
        CHECK(near(rotation_from_euler(out), C, 2e-15));
        CHECK(near(out.pitch_rad, in.pitch_rad, 1e-15));
        CHECK((out.yaw_rad >= 0.0 && out.yaw_rad < 2.0 * std::numbers::pi));
        if (std::abs(pitch_deg) < 90.0) {
          CHECK(near(wrap_pi(out.roll_rad - in.roll_rad), 0.0, spread));
          CHECK(near(wrap_pi(out.yaw_rad - in.yaw_rad), 0.0, spread));
        } else {
          CHECK(out.roll_rad == 0.0);
        }
      }
    }
  }
}

TEST_CASE("a yaw a hair below zero stays below a full turn") {
  const EulerAngles out = euler_from_rotation(rotation_from_euler({0.0, 0.0, -1e-18}));
  CHECK(out.yaw_rad < 2.0 * std::numbers::pi);
  CHECK(out.yaw_rad > 6.28);
}

TEST_CASE("wrap_pi keeps angles in (-pi, pi]") {
  CHECK(wrap_pi(0.25) == 0.25);
  CHECK(wrap_pi(std::numbers::pi) == std::numbers::pi);
  CHECK(wrap_pi(-std::numbers::pi) == std::numbers::pi);
  CHECK(near(wrap_pi(3.5 * std::numbers::pi), -0.5 * std::numbers::pi, 2e-15));
  CHECK(near(wrap_pi(-100.0 * std::numbers::pi + 0.1), 0.1, 6e-14));  // ulp(314) = 5.7e-14
}

}  // namespace leeway
