#include "leeway/navigator/alignment.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "leeway/covariance/covariance.hpp"
#include "leeway/earth/earth.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway {
namespace {

constexpr double kLongestLagS = 0.3;        // between the halves of a fix
constexpr double kVelocityMayComeS = 10.0;  // a receiver silent for longer gives none
constexpr double kShortestBaseS = 4.0;      // between positions: over less, noise is all there is
constexpr double kLongestBaseS = 61.0;
constexpr double kLargestTiltRad = 0.35;  // beyond, an attitude is no start for a linear filter
constexpr double kUnseenMps2 = 0.5;       // by which a velocity may differ from its mean

/// Where a fix says, with this attitude.
Alignment start_at(const GnssFix& fix, const Eigen::Quaterniond& q_eb) {
  Alignment start;
  start.estimate.nav.time = fix.time;
  start.estimate.nav.q_eb = q_eb.normalized();
  start.estimate.nav.v_e_mps = fix.velocity->v_e_mps;
  start.estimate.nav.r_e_m = fix.position->r_e_m;
  return start;
}

/// The largest of a fix's axes; nothing of the attitude.
InitialSigma sigma_of(const GnssFix& fix) {
  InitialSigma sigma;
  sigma.position_m = std::sqrt(fix.position->R_e_m2.diagonal().maxCoeff());
  sigma.velocity_mps = std::sqrt(fix.velocity->R_e_m2ps2.diagonal().maxCoeff());
  return sigma;
}

}  // namespace

EulerAngles level(const Eigen::Vector3d& f_b_mps2, const Eigen::Vector3d& f_level_mps2) {
  const double in_yz = std::hypot(f_b_mps2.y(), f_b_mps2.z());
  const double lateral = in_yz > 0.0 ? std::clamp(f_level_mps2.y() / in_yz, -1.0, 1.0) : 0.0;
  EulerAngles rpy;
  rpy.roll_rad = wrap_pi(std::asin(lateral) - std::atan2(f_b_mps2.y(), -f_b_mps2.z()));
  const double down = f_b_mps2.y() * std::sin(rpy.roll_rad) + f_b_mps2.z() * std::cos(rpy.roll_rad);
  rpy.pitch_rad = std::atan2(f_b_mps2.x(), -down) - std::atan2(f_level_mps2.x(), -f_level_mps2.z());
  return rpy;
}

Aligner::Aligner(const AlignmentConfig& config, const EkfConfig& filter)
    : config_(config), filter_(filter) {
  validate_fields("alignment", config);
}

void Aligner::Sum::add(const ImuIncrement& inc) {
  dt_s += inc.dt_s;
  dtheta_b_rad += inc.dtheta_b_rad;
  dv_b_mps += inc.dv_b_mps;
  const Eigen::Vector3d felt_mps =
      q_start_end * (exp_quaternion(0.5 * inc.dtheta_b_rad) * inc.dv_b_mps);
  dr_start_m += inc.dt_s * (dv_start_mps + 0.5 * felt_mps);
  dv_start_mps += felt_mps;
  q_start_end = (q_start_end * exp_quaternion(inc.dtheta_b_rad)).normalized();
}

void Aligner::push(const ImuIncrement& inc) {
  since_fix_.add(inc);
  since_first_.add(inc);
  since_heading_.add(inc);
}

std::optional<Alignment> Aligner::push(const GnssFix& fix) {
  if (fix.velocity) newest_velocity_ = fix.time;
  const bool has_velocity =
      newest_velocity_ && to_seconds(fix.time - *newest_velocity_) < kVelocityMayComeS;
  if (!has_velocity) return take_position(fix);
  if (fix.position && fix.velocity) return take(fix);
  const bool completes = half_ && half_->position.has_value() == fix.velocity.has_value() &&
                         to_seconds(fix.time - half_->time) <= kLongestLagS;
  if (!completes) {
    half_ = fix;
    return std::nullopt;
  }
  GnssFix whole = fix;
  if (!whole.position) whole.position = half_->position;
  if (!whole.velocity) whole.velocity = half_->velocity;
  half_.reset();
  return take(whole);
}

std::optional<Alignment> Aligner::take(const GnssFix& fix) {
  const bool in_a_row = previous_ && since_fix_.dt_s > 0.0 &&
                        to_seconds(fix.time - previous_->time) <= config_.max_fix_interval_s;
  std::optional<Alignment> result;
  if (previous_ && !in_a_row && fix.position) result = align_apart(fix, *previous_->velocity);
  if (in_a_row) {
    const bool at_rest = watch_rest(*fix.velocity);
    const bool moving = fix.velocity->v_e_mps.norm() >= config_.min_speed_mps &&
                        previous_->velocity->v_e_mps.norm() >= 0.5 * config_.min_speed_mps;
    if (!fix.position) {
      // A start needs a place.
    } else if (config_.heading_from_course && votes_ == 0) {
      if (moving) result = align_by_course(fix, *previous_->velocity);
    } else if (!at_rest || rest_.dt_s >= config_.min_level_s) {
      result = level_only(fix, *previous_->velocity, at_rest);
    }
  }
  previous_ = fix;
  since_fix_ = Sum{};
  return result;
}

bool Aligner::watch_rest(const GnssVelocity& velocity) {
  const double free_turn_rad =
      config_.rest_turn_rad + 3.0 * filter_.imu.gyro.bias_sigma * since_fix_.dt_s;
  const bool at_rest = velocity.v_e_mps.norm() < config_.rest_speed_mps &&
                       previous_->velocity->v_e_mps.norm() < config_.rest_speed_mps &&
                       since_fix_.dtheta_b_rad.norm() < free_turn_rad;
  if (!at_rest) return false;
  rest_.dt_s += since_fix_.dt_s;
  rest_.dtheta_b_rad += since_fix_.dtheta_b_rad;
  rest_.dv_b_mps += since_fix_.dv_b_mps;
  return true;
}

/// Two fixes that are far apart.
std::optional<Alignment> Aligner::align_apart(const GnssFix& fix,
                                              const GnssVelocity& before) const {
  const Sum& sum = since_fix_;
  if (!(sum.dt_s > 0.0 && sum.dt_s <= kLongestBaseS)) return std::nullopt;
  const double sigma_mps = std::sqrt(before.R_e_m2ps2.diagonal().maxCoeff() +
                                     fix.velocity->R_e_m2ps2.diagonal().maxCoeff());
  return align_by({fix.velocity->v_e_mps - before.v_e_mps, sum.dv_start_mps, sum.dt_s,
                   sum.q_start_end, sigma_mps, 0.0},
                  fix);
}

/// The second difference of three positions is a change of velocity; of what the IMU has felt the
/// same difference is taken.
std::optional<Alignment> Aligner::take_position(const GnssFix& fix) {
  const double first_base_s = until_middle_.dt_s;
  const double base_s = since_first_.dt_s - (middle_ ? first_base_s : 0.0);
  if (!first_ || since_first_.dt_s > 2.0 * kLongestBaseS) {
    first_ = fix;
    middle_.reset();
    since_first_ = Sum{};
    return std::nullopt;
  }
  if (base_s < kShortestBaseS || (middle_ && base_s < 0.9 * first_base_s)) return std::nullopt;
  if (!middle_) {
    middle_ = fix;
    until_middle_ = since_first_;
    return std::nullopt;
  }
  const Eigen::Vector3d v_e_mps = (fix.position->r_e_m - middle_->position->r_e_m) / base_s;
  const Eigen::Vector3d dv_e_mps =
      v_e_mps - (middle_->position->r_e_m - first_->position->r_e_m) / first_base_s;
  const Eigen::Vector3d felt_mps = (since_first_.dr_start_m - until_middle_.dr_start_m) / base_s -
                                   until_middle_.dr_start_m / first_base_s;
  const double over_s = 0.5 * (first_base_s + base_s);
  const double sigma_m = std::sqrt(fix.position->R_e_m2.diagonal().maxCoeff());
  const Eigen::Quaterniond q_turn =
      until_middle_.q_start_end.conjugate() * since_first_.q_start_end;
  const double turn_rad = 2.0 * std::acos(std::min(1.0, std::abs(q_turn.w())));
  GnssFix whole = fix;
  const double bend_mps = (dv_e_mps.norm() / over_s + kUnseenMps2) * 0.5 * base_s;
  const double sigma_mps = std::hypot(std::sqrt(2.0) * sigma_m / base_s, bend_mps);
  whole.velocity = {v_e_mps, sigma_mps * sigma_mps * Eigen::Matrix3d::Identity()};
  const Push push{dv_e_mps,
                  felt_mps,
                  over_s,
                  since_first_.q_start_end,
                  std::sqrt(6.0) * sigma_m / std::min(base_s, first_base_s),
                  turn_rad};
  const auto result = align_by(push, whole);
  first_ = fix;
  middle_.reset();
  since_first_ = Sum{};
  return result;
}

std::optional<Alignment> Aligner::align_by(const Push& push, const GnssFix& fix) const {
  const Eigen::Vector3d f_e_mps =
      push.dv_e_mps - push.over_s * gravity_e(GravityModel::kNormal, fix.position->r_e_m);
  InitialSigma sigma = sigma_of(fix);
  sigma.tilt_rad =
      std::hypot(std::hypot(config_.tilt_floor_rad,
                            filter_.imu.accelerometer.bias_sigma / kStandardGravityMps2),
                 push.sigma_mps / (push.over_s * kStandardGravityMps2),
                 std::min(filter_.imu.gyro.bias_sigma * push.over_s, kLargestTiltRad));
  sigma.heading_rad = sigma.tilt_rad;
  if (sigma.tilt_rad > 2.0 * kLargestTiltRad) return std::nullopt;

  const Eigen::Quaterniond q_e_start = rotation_between(push.felt_mps, f_e_mps);
  Eigen::Quaterniond q_eb = q_e_start * push.q_start_end;
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(fix.position->r_e_m));
  const Eigen::Vector3d v_n = C_en.transpose() * fix.velocity->v_e_mps;
  const double speed_mps = v_n.head<2>().norm();
  double turn_sigma_rad = std::numbers::pi;
  if (config_.heading_from_course && votes_ == 0 && speed_mps >= config_.min_speed_mps) {
    // The course is the mean one of the last interval: half a turn ago.
    const Eigen::Vector3d forward_n = C_en.transpose() * (q_eb * Eigen::Vector3d::UnitX());
    const double yaw_rad =
        wrap_pi(std::atan2(v_n.y(), v_n.x()) - std::atan2(forward_n.y(), forward_n.x()));
    q_eb = exp_quaternion(yaw_rad * C_en.col(2)) * q_eb;
    turn_sigma_rad = std::hypot(config_.sideslip_rad,
                                std::hypot(sigma.velocity_mps / speed_mps, 0.5 * push.turn_rad));
  }
  Alignment result = start_at(fix, q_eb);
  result.axis_e = C_en.col(2);
  result.turn_sigma_rad = turn_sigma_rad;
  result.P = initial_covariance(result.estimate, sigma, filter_.imu);
  transform_block(result.P, kPsi,
                  Eigen::Matrix3d::Identity() - result.axis_e * result.axis_e.transpose());
  turn_to_heading(result);
  return result;
}

Alignment Aligner::align_by_course(const GnssFix& fix, const GnssVelocity& before) const {
  const double dt_s = since_fix_.dt_s;
  const Geodetic place = geodetic_from_ecef(fix.position->r_e_m);
  const Eigen::Matrix3d C_en = ned_to_ecef(place);
  const Eigen::Vector3d v_n = C_en.transpose() * fix.velocity->v_e_mps;
  const Eigen::Vector3d v_old_n = C_en.transpose() * before.v_e_mps;
  const double speed_mps = std::hypot(v_n.x(), v_n.y());
  const double course_rad = std::atan2(v_n.y(), v_n.x());
  const double course_old_rad = std::atan2(v_old_n.y(), v_old_n.x());
  // The means belong to the middle of the interval, so the heading of the middle goes with them.
  const double turn_rad = wrap_pi(course_rad - course_old_rad);
  const double course_mid_rad = course_old_rad + 0.5 * turn_rad;

  const Eigen::Vector3d f_n =
      (v_n - v_old_n) / dt_s -
      C_en.transpose() * gravity_e(GravityModel::kNormal, fix.position->r_e_m);
  const Eigen::Vector3d f_level = rotation_from_euler({0.0, 0.0, course_mid_rad}).transpose() * f_n;
  EulerAngles rpy = level(since_fix_.dv_b_mps / dt_s, f_level);
  rpy.yaw_rad = course_rad;

  Alignment result = start_at(fix, Eigen::Quaterniond(C_en * rotation_from_euler(rpy)));
  result.from_course = true;
  result.axis_e = (C_en * f_n).normalized();
  Estimate& estimate = result.estimate;
  const Eigen::Vector3d omega_b = since_fix_.dtheta_b_rad / dt_s;
  const Eigen::Vector3d lever = filter_.lever_arm_b_m;
  estimate.nav.r_e_m -= antenna_position_e(estimate, lever) - fix.position->r_e_m;
  estimate.nav.v_e_mps -= antenna_velocity_e(estimate, lever, omega_b) - fix.velocity->v_e_mps;

  InitialSigma sigma = sigma_of(fix);
  sigma.heading_rad =
      std::hypot(config_.sideslip_rad, sigma.velocity_mps / speed_mps, 0.5 * turn_rad);
  sigma.tilt_rad = std::hypot(config_.tilt_floor_rad,
                              filter_.imu.accelerometer.bias_sigma / kStandardGravityMps2,
                              std::sqrt(2.0) * sigma.velocity_mps / (dt_s * kStandardGravityMps2));
  result.P = initial_covariance(estimate, sigma, filter_.imu);
  set_rest_bias(result);
  return result;
}

Alignment Aligner::level_only(const GnssFix& fix, const GnssVelocity& before, bool at_rest) const {
  const double dt_s = at_rest ? rest_.dt_s : since_fix_.dt_s;
  const Eigen::Vector3d f_b = (at_rest ? rest_.dv_b_mps : since_fix_.dv_b_mps) / dt_s;
  const Eigen::Vector3d turn_e = fix.velocity->v_e_mps - before.v_e_mps;
  const Eigen::Vector3d a_e = at_rest ? Eigen::Vector3d::Zero() : Eigen::Vector3d(turn_e / dt_s);
  const Eigen::Vector3d f_e = a_e - gravity_e(GravityModel::kNormal, fix.position->r_e_m);

  Alignment result = start_at(fix, rotation_between(f_b, f_e));
  Eigen::Quaterniond& q_eb = result.estimate.nav.q_eb;
  // The measured force is the mean of the interval, the attitude wanted that of its end.
  const Eigen::Vector3d half_turn_b = 0.5 * since_fix_.dtheta_b_rad;
  if (!at_rest) q_eb = (q_eb * exp_quaternion(half_turn_b)).normalized();
  result.axis_e = f_e.normalized();
  result.turn_sigma_rad = std::numbers::pi;

  InitialSigma sigma = sigma_of(fix);
  const double sigma_a_mps2 = at_rest ? 0.0 : std::sqrt(2.0) * sigma.velocity_mps / dt_s;
  sigma.tilt_rad =
      std::hypot(config_.tilt_floor_rad,
                 std::hypot(filter_.imu.accelerometer.bias_sigma, sigma_a_mps2) / f_e.norm());
  sigma.heading_rad = sigma.tilt_rad;
  result.P = initial_covariance(result.estimate, sigma, filter_.imu);
  // The turn about the axis is told apart from the rest.
  transform_block(result.P, kPsi,
                  Eigen::Matrix3d::Identity() - result.axis_e * result.axis_e.transpose());
  set_rest_bias(result);
  turn_to_heading(result);
  return result;
}

void Aligner::set_rest_bias(Alignment& result) const {
  if (rest_.dt_s >= config_.min_rest_s) {
    result.estimate.bias.b_g_radps = rest_.dtheta_b_rad / rest_.dt_s;
    // What is left of the bias: white noise over the rest, the Earth's rotation, which was taken
    // for bias, and the in-run drift.
    const TriadErrorModel& gyro = filter_.imu.gyro;
    const double variance = gyro.noise_density * gyro.noise_density / rest_.dt_s +
                            wgs84::kRotationRateRadps * wgs84::kRotationRateRadps +
                            gyro.in_run.sigma * gyro.in_run.sigma;
    result.P.diagonal().segment<3>(kBg).setConstant(variance);
  }
}

}  // namespace leeway
