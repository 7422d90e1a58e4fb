#include "leeway/monitors/course_monitor.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/model/heading.hpp"

namespace leeway {
namespace {

constexpr double kLeastSpeedMps = 5.0;   // a car backs more slowly
constexpr double kLeastIntervalS = 0.4;  // receivers smooth: closer velocities err alike
constexpr double kAxleM = 2.0;           // antenna to rear axle: in a turn it goes sideways
// Of mount and slip, on a straight: 0.3 deg in a minute.
constexpr double kWanderRad2PerS = 0.005 * 0.005 / 60.0;

}  // namespace

bool CourseMonitor::push(const GnssFix& fix, const Ekf& filter) {
  const Estimate& estimate = filter.estimate();
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(estimate.nav.r_e_m));
  const Azimuth course(fix.velocity->v_e_mps, C_en);
  const double speed_mps = course.level_part;
  const double since_s = previous_ ? to_seconds(fix.time - *previous_) : kLeastIntervalS;
  if (speed_mps < kLeastSpeedMps || since_s < kLeastIntervalS) return false;
  previous_ = fix.time;
  const Azimuth heading(estimate.nav.q_eb * Eigen::Vector3d::UnitX(), C_en);
  const double difference_rad = wrap_pi(course.angle_rad - heading.angle_rad);
  const double turn_radps =
      (filter.inertial().mean_omega_ib_b_radps() - estimate.bias.b_g_radps).norm();
  const double course_rad =
      std::hypot(std::sqrt(fix.velocity->R_e_m2ps2.diagonal().maxCoeff()), kAxleM * turn_radps) /
      speed_mps;
  const double course_rad2 = course_rad * course_rad + drift_rad_ * drift_rad_;
  const double heading_rad2 = std::pow(heading_sigma_rad(filter), 2);
  const double change_rad = wrap_pi(difference_rad - offset_rad_);
  const double variance_rad2 =
      offset_variance_rad2_ + std::max(learned_heading_rad2_, heading_rad2) + course_rad2;
  learn(change_rad, course_rad2, heading_rad2, since_s);
  if (!cusum_.push(change_rad * change_rad / variance_rad2, 1)) return false;
  offset_rad_ = 0.0;
  offset_variance_rad2_ = 1.0;
  learned_heading_rad2_ = 0.0;
  return true;
}

// A Kalman filter of the difference, a random walk. It takes in the heading's error, too, which
// may come to light at any time.
void CourseMonitor::learn(double change_rad, double course_rad2, double heading_rad2,
                          double since_s) {
  offset_variance_rad2_ += kWanderRad2PerS * since_s;
  const double gain = offset_variance_rad2_ / (offset_variance_rad2_ + heading_rad2 + course_rad2);
  offset_rad_ = wrap_pi(offset_rad_ + gain * change_rad);
  offset_variance_rad2_ *= 1.0 - gain;
  learned_heading_rad2_ += gain * (heading_rad2 - learned_heading_rad2_);
}

}  // namespace leeway
