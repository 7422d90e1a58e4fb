#include "leeway/monitors/coast_monitor.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"

namespace leeway {
namespace {

constexpr double kCopyStepS = 0.1;        // a vehicle moves smoothly in it
constexpr double kShortestCoastS = 10.0;  // or as long as it takes to drift by more than fixes err
constexpr double kLongestCoastS = 60.0;
constexpr double kTellingRatio = 4.0;      // of the copy's variance to the filter's
constexpr double kLargestCoastNis = 20.0;  // one comparison alone shall not decide
constexpr double kMostDof = 60.0;          // 30 comparisons: five minutes and more
constexpr double kLeastImuFactor = 0.3;
constexpr double kLargestImuFactor = 30.0;
constexpr int kVelocityDof = 2;
constexpr double kLargestTurnRatio = 19.5;           // 1e-5, one degree of freedom
constexpr double kLinearTurnRad = 1.0 * kRadPerDeg;  // 1 sigma of what linearization leaves

/// Whether measurements have turned the filter's heading by more than either claims. Two estimates
/// of which the one has seen all that the other has differ by the difference of their covariances.
bool turned_beyond_claim(const Ekf& copy, const Ekf& filter) {
  const NavState& nav = filter.estimate().nav;
  const Eigen::Vector3d turn_e_rad =
      log_quaternion(nav.q_eb * copy.estimate().nav.q_eb.conjugate());
  const double turn_rad = nav.r_e_m.normalized().dot(turn_e_rad);
  const double gained_rad2 =
      std::pow(heading_sigma_rad(copy), 2) - std::pow(heading_sigma_rad(filter), 2);
  return turn_rad * turn_rad >
         kLargestTurnRatio * (std::max(gained_rad2, 0.0) + kLinearTurnRad * kLinearTurnRad);
}

}  // namespace

void CoastMonitor::push(const ImuIncrement& inc) {
  if (!copy_) return;
  time_ = inc.time;
  dt_s_ += inc.dt_s;
  dtheta_b_rad_ += inc.dtheta_b_rad;
  dv_b_mps_ += inc.dv_b_mps;
  if (dt_s_ + 0.5 * inc.dt_s > kCopyStepS) catch_up();
}

void CoastMonitor::catch_up() {
  if (dt_s_ == 0.0) return;
  copy_->predict(
      {.time = time_, .dt_s = dt_s_, .dtheta_b_rad = dtheta_b_rad_, .dv_b_mps = dv_b_mps_});
  dt_s_ = 0.0;
  dtheta_b_rad_.setZero();
  dv_b_mps_.setZero();
}

bool CoastMonitor::compare(const Ekf& filter) {
  const NavState& nav = filter.estimate().nav;
  if (copy_) {
    catch_up();
    if (turned_beyond_claim(*copy_, filter)) {
      restart();
      return true;
    }
    const double coasted_s = to_seconds(nav.time - start_);
    if (coasted_s < kShortestCoastS) return false;
    if (!compare_velocity(filter) && coasted_s < kLongestCoastS) return false;
  }
  copy_ = filter;
  start_ = time_ = nav.time;
  dt_s_ = 0.0;
  dtheta_b_rad_.setZero();
  dv_b_mps_.setZero();
  return false;
}

bool CoastMonitor::compare_velocity(const Ekf& filter) {
  const NavState& nav = filter.estimate().nav;
  const Eigen::Matrix<double, 3, 2> C_eh =
      ned_to_ecef(geodetic_from_ecef(nav.r_e_m)).leftCols<2>();
  const auto horizontal = [&](const Ekf& f) -> Eigen::Matrix2d {
    return C_eh.transpose() * f.covariance().block<3, 3>(kDv, kDv) * C_eh;
  };
  const Eigen::Matrix2d of_copy = horizontal(*copy_);
  const Eigen::Matrix2d of_filter = horizontal(filter);
  if (of_copy.trace() < kTellingRatio * of_filter.trace()) return false;
  // Half of the filter's, so that it stays positive where both know as little.
  const Eigen::Matrix2d S = of_copy - 0.5 * of_filter;
  const Eigen::Vector2d difference_mps =
      C_eh.transpose() * (copy_->estimate().nav.v_e_mps - nav.v_e_mps);
  learn(difference_mps.dot(S.inverse() * difference_mps), copy_->inertial().noise_scale());
  return true;
}

void CoastMonitor::learn(double nis, double scale_of_copy) {
  if (!std::isfinite(nis)) return;
  const double relative = scale_of_copy / imu_sigma_scale_;
  const double sum = std::min(nis, kLargestCoastNis) * relative * relative;
  imu_sigma_scale_ *= std::sqrt((known_dof_ + sum) / (known_dof_ + kVelocityDof));
  imu_sigma_scale_ = std::clamp(imu_sigma_scale_, kLeastImuFactor, kLargestImuFactor);
  known_dof_ = std::min(known_dof_ + kVelocityDof, kMostDof);
}

}  // namespace leeway
