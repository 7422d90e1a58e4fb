#include "leeway/monitors/course_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/heading.hpp"

namespace leeway {
namespace {

constexpr double kLeastSpeedMps = 5.0;  // a car backs more slowly
constexpr double kLearnS = 60.0;
constexpr double kSteadyRad = 0.005;    // change of mount and slip on a straight
constexpr double kAxleM = 2.0;          // antenna to rear axle: in a turn it goes sideways

}  // namespace

bool CourseMonitor::push(const GnssFix& fix, const Ekf& filter) {
  const Estimate& estimate = filter.estimate();
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(estimate.nav.r_e_m));
  const Azimuth course(fix.velocity->v_e_mps, C_en);
  const double speed_mps = course.level_part;
  if (speed_mps < kLeastSpeedMps) return false;
  const Azimuth heading(estimate.nav.q_eb * Eigen::Vector3d::UnitX(), C_en);
  const double difference_rad = wrap_pi(course.angle_rad - heading.angle_rad);
  const double turn_radps =
      (filter.inertial().mean_omega_ib_b_radps() - estimate.bias.b_g_radps).norm();
  const double course_rad =
      std::hypot(std::sqrt(fix.velocity->R_e_m2ps2.diagonal().maxCoeff()), kAxleM * turn_radps) /
      speed_mps;
  const double change_rad = wrap_pi(difference_rad - offset_rad_);
  const double heading_rad2 = std::pow(heading_sigma_rad(filter), 2);
  const double variance_rad2 =
      offset_variance_rad2_ + heading_rad2 + course_rad * course_rad + drift_rad_ * drift_rad_;
  // A heading that is less sure than the difference tells little of it.
  const double known = offset_variance_rad2_ / (offset_variance_rad2_ + heading_rad2);
  const double since_s = previous_ ? to_seconds(fix.time - *previous_) : 0.0;
  const double share = known * std::clamp(since_s / kLearnS, 0.0, 1.0);
  previous_ = fix.time;
  offset_rad_ = wrap_pi(offset_rad_ + share * change_rad);
  offset_variance_rad2_ += share * (kSteadyRad * kSteadyRad - offset_variance_rad2_);
  if (!cusum_.push(change_rad * change_rad / variance_rad2, 1)) return false;
  offset_rad_ = 0.0;
  offset_variance_rad2_ = 1.0;
  return true;
}

}  // namespace leeway
