#include "leeway/earth/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace leeway {
namespace {

constexpr double kGimbalRad = 1e-8;

// Below this angle the Taylor terms kept are exact to rounding: the first one left out is
// theta^6 / 5040 = 2e-16 relative at 0.01 rad.
constexpr double kSmallAngleSq = 1e-4;

// Factors of a series are multiplied by, known when compiled: a division takes as long as four
// multiplications, and a strapdown step would have twenty of them.
double sinc(double theta_sq) {
  if (theta_sq < kSmallAngleSq) {
    return 1.0 - 1.0 / 6.0 * theta_sq * (1.0 - 1.0 / 20.0 * theta_sq);
  }
  const double theta = std::sqrt(theta_sq);
  return std::sin(theta) / theta;
}

// (1 - cos theta) / theta^2
double versine_ratio(double theta_sq) {
  const double half_sinc = sinc(0.25 * theta_sq);
  return 0.5 * half_sinc * half_sinc;
}

// (theta - sin theta) / theta^3. The closed form loses digits below about 0.5 rad.
double sine_deficit_ratio(double theta_sq) {
  if (theta_sq < 0.25) {
    double sum = 0.0;
    for (double n : {14.0, 12.0, 10.0, 8.0, 6.0, 4.0}) {
      sum = 1.0 / (n * (n + 1.0)) * theta_sq * (1.0 - sum);
    }
    return 1.0 / 6.0 * (1.0 - sum);
  }
  return (1.0 - sinc(theta_sq)) / theta_sq;
}

}  // namespace

Eigen::Quaterniond exp_quaternion(const Eigen::Vector3d& phi_rad) {
  const double half_sq = 0.25 * phi_rad.squaredNorm();
  const Eigen::Vector3d vec = 0.5 * sinc(half_sq) * phi_rad;
  return {std::cos(std::sqrt(half_sq)), vec.x(), vec.y(), vec.z()};
}

Eigen::Vector3d log_quaternion(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0.0 ? -1.0 : 1.0;
  const double sin_half = q.vec().norm();
  if (sin_half < 1e-150) {
    return 2.0 * q.vec() * sign;
  }
  return 2.0 * std::atan2(sin_half, sign * q.w()) / sin_half * sign * q.vec();
}

Eigen::Matrix3d exp_rotation(const Eigen::Vector3d& phi_rad) {
  return exp_quaternion(phi_rad).toRotationMatrix();
}

Eigen::Vector3d log_rotation(const Eigen::Matrix3d& C) {
  return log_quaternion(Eigen::Quaterniond(C));
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi_rad) {
  const double theta_sq = phi_rad.squaredNorm();
  const Eigen::Matrix3d S = skew(phi_rad);
  return Eigen::Matrix3d::Identity() + versine_ratio(theta_sq) * S +
         sine_deficit_ratio(theta_sq) * S * S;
}

Eigen::Vector3d left_jacobian_times(const Eigen::Vector3d& phi_rad, const Eigen::Vector3d& v) {
  const double theta_sq = phi_rad.squaredNorm();
  const Eigen::Vector3d turned_v = phi_rad.cross(v);
  return v + versine_ratio(theta_sq) * turned_v +
         sine_deficit_ratio(theta_sq) * phi_rad.cross(turned_v);
}

Eigen::Quaterniond turned(const Eigen::Vector3d& left_a_rad, const Eigen::Quaterniond& q_ab,
                          const Eigen::Vector3d& right_b_rad) {
  // exp(phi) - 1 with its scalar part as -2 sin^2(theta/4): no cancellation.
  const auto small_turn = [](const Eigen::Vector3d& phi) {
    const double half_sq = 0.25 * phi.squaredNorm();
    const Eigen::Vector3d vec = 0.5 * sinc(half_sq) * phi;
    const Eigen::Quaterniond quaternion(-half_sq * versine_ratio(half_sq), vec.x(), vec.y(),
                                        vec.z());
    return quaternion;
  };
  Eigen::Quaterniond q = q_ab;
  q.coeffs() += (q * small_turn(right_b_rad)).coeffs();
  // The norm is restored within the addition: a factor of 1 +- 1 ulp rounds unevenly, which turns
  // the attitude by 2e-18 rad at every step, always the same way.
  q.coeffs() += (small_turn(left_a_rad) * q).coeffs() + (0.5 - 0.5 * q.squaredNorm()) * q.coeffs();
  return q;
}

Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  // Eigen's FromTwoVectors does the same, with a singular value decomposition for opposite ones
  // that takes ten seconds to compile.
  constexpr double kOpposite = -1.0 + 1e-12;
  const Eigen::Vector3d a = from.normalized();
  const Eigen::Vector3d b = to.normalized();
  const double c = a.dot(b);
  Eigen::Quaterniond q;
  if (c < kOpposite) {
    q.w() = std::sqrt(0.5 * (1.0 + std::max(c, -1.0)));
    q.vec() = std::sqrt(1.0 - q.w() * q.w()) * a.unitOrthogonal();
  } else {
    const double s = std::sqrt((1.0 + c) * 2.0);
    q.vec() = a.cross(b) * (1.0 / s);
    q.w() = 0.5 * s;
  }
  return q;
}

Eigen::Matrix3d rotation_from_euler(const EulerAngles& rpy) {
  return (Eigen::AngleAxisd(rpy.yaw_rad, Eigen::Vector3d::UnitZ()) *
          Eigen::AngleAxisd(rpy.pitch_rad, Eigen::Vector3d::UnitY()) *
          Eigen::AngleAxisd(rpy.roll_rad, Eigen::Vector3d::UnitX()))
      .toRotationMatrix();
}

EulerAngles euler_from_rotation(const Eigen::Matrix3d& C_nb) {
  EulerAngles rpy;
  const double cos_pitch = std::hypot(C_nb(2, 1), C_nb(2, 2));
  rpy.pitch_rad = std::atan2(-C_nb(2, 0), cos_pitch);
  if (cos_pitch > kGimbalRad) rpy.roll_rad = std::atan2(C_nb(2, 1), C_nb(2, 2));
  // Yaw after undoing this very roll: near the vertical each of the two is uncertain, but together
  // they are the rotation.
  const double sin_roll = std::sin(rpy.roll_rad);
  const double cos_roll = std::cos(rpy.roll_rad);
  rpy.yaw_rad = std::atan2(sin_roll * C_nb(0, 2) - cos_roll * C_nb(0, 1),
                           cos_roll * C_nb(1, 1) - sin_roll * C_nb(1, 2));
  if (rpy.yaw_rad < 0.0) {
    rpy.yaw_rad =
        std::min(rpy.yaw_rad + 2.0 * std::numbers::pi, std::nextafter(2.0 * std::numbers::pi, 0.0));
  }
  return rpy;
}

double wrap_pi(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * std::numbers::pi);
  return wrapped == -std::numbers::pi ? std::numbers::pi : wrapped;
}

}  // namespace leeway
