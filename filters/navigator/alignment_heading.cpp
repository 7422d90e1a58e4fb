// What the aligner makes of measured headings.
#include <algorithm>
#include <cmath>

#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/heading.hpp"
#include "leeway/navigator/alignment.hpp"

namespace leeway {

// The majority's vote: Boyer and Moore (1981).
void Aligner::push(const MeasuredHeading& heading) {
  constexpr double kSigmas = 5.0;
  constexpr int kMostVotes = 20;
  const Eigen::Vector3d down_b = -since_heading_.dv_b_mps.normalized();
  const double turn_rad = down_b.dot(log_quaternion(since_heading_.q_start_end));
  const double off_rad = wrap_pi(heading.heading_rad - heading_.heading_rad - turn_rad);
  const bool agrees =
      std::abs(off_rad) < kSigmas * std::hypot(heading.sigma_rad, carried_sigma_rad());
  if (votes_ > 0 && !agrees) {
    --votes_;
    return;
  }
  votes_ = std::min(votes_ + 1, kMostVotes);
  heading_ = heading;
  since_heading_ = Sum{};
}

double Aligner::carried_sigma_rad() const {
  return std::hypot(heading_.sigma_rad, filter_.imu.gyro.bias_sigma * since_heading_.dt_s);
}

/// Turns about the axis that levelling leaves open until the heading is the measured one. A body
/// that stood upright at its time is left as it is.
void Aligner::turn_to_heading(Alignment& result) const {
  constexpr double kLeastSlope = 0.5;  // of heading by turn: the axis is near the vertical
  constexpr int kSteps = 5;            // of Newton's method; about the vertical one is exact
  if (votes_ == 0) return;
  NavState nav = result.estimate.nav;
  const Eigen::Vector3d forward_b =
      since_heading_.q_start_end.conjugate() * Eigen::Vector3d::UnitX();
  double level_part = 1.0;
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Vector3d forward_e = nav.q_eb * forward_b;
    const Azimuth azimuth(forward_e, nav.r_e_m);
    const double slope = result.axis_e.cross(forward_e).dot(azimuth.gradient_e);
    if (!azimuth.is_defined() || std::abs(slope) < kLeastSlope) return;
    const double turn_rad = wrap_pi(heading_.heading_rad - azimuth.angle_rad) / slope;
    nav.q_eb = (exp_quaternion(turn_rad * result.axis_e) * nav.q_eb).normalized();
    level_part = azimuth.level_part;
  }
  const Eigen::Matrix3d turn_e =
      (nav.q_eb * result.estimate.nav.q_eb.conjugate()).toRotationMatrix();
  transform_block(result.P, kPsi, turn_e);
  nav.r_e_m -= nav.q_eb * filter_.lever_arm_b_m;
  result.estimate.nav = nav;
  const double tilt_rad = std::sqrt(result.P.diagonal().segment<3>(kPsi).maxCoeff());
  const double slant = std::sqrt(std::max(0.0, 1.0 - level_part * level_part)) / level_part;
  result.turn_sigma_rad = std::hypot(carried_sigma_rad(), tilt_rad * slant);
}

}  // namespace leeway
