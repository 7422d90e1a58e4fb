#include "leeway/monitors/velocity_changes.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace leeway {
namespace {

constexpr double kChangesS = 30.0;
constexpr double kLongestChangeS = 2.5;  // accelerations last for less in turns
constexpr double kSetAnewSigmas = 6.0;
constexpr double kLeastSetAnewS = 0.15;
constexpr double kLeastChanges = 12.0;       // components
constexpr double kExplainedShare = 0.5;      // else it is something else that is wrong
constexpr double kAgeInformation = 1.0;      // 1 / s^2, of before
constexpr double kHeadingInformation = 4.0;  // 1 / rad^2: 30 deg

}  // namespace

void VelocityChanges::push(const GnssFix& fix, const Eigen::Vector3d& a_e_mps2,
                           const Eigen::Vector3d& lever_e_mps, const Eigen::Vector3d& down_e) {
  const double variance_m2ps2 = fix.velocity->R_e_m2ps2.trace() / 3.0;
  const double dt_s = time_ ? to_seconds(fix.time - *time_) : 0.0;
  if (dt_s > 0.0 && dt_s < kLongestChangeS) {
    const Eigen::Vector3d left_mps =
        fix.velocity->v_e_mps - v_e_mps_ - felt_e_mps_ - (lever_e_mps - lever_e_mps_);
    Eigen::Matrix<double, 3, 2> by;
    by << a_e_mps2_ - a_e_mps2, down_e.cross(felt_e_mps_);
    const double weight = 1.0 / (variance_m2ps2_ + variance_m2ps2);
    const double kept = std::exp(-dt_s / kChangesS);
    information_ = kept * information_ + weight * by.transpose() * by;
    pull_ = kept * pull_ + weight * by.transpose() * left_mps;
    square_ = kept * square_ + weight * left_mps.squaredNorm();
    count_ = kept * count_ + 3.0;
  }
  time_ = fix.time;
  v_e_mps_ = fix.velocity->v_e_mps;
  a_e_mps2_ = a_e_mps2;
  lever_e_mps_ = lever_e_mps;
  variance_m2ps2_ = variance_m2ps2;
  felt_e_mps_.setZero();
}

std::optional<VelocityChanges::Age> VelocityChanges::other_than(double known_s) const {
  if (count_ < kLeastChanges) return {};
  Eigen::Matrix2d information = information_;
  information(0, 0) += kAgeInformation;
  information(1, 1) += kHeadingInformation;
  const Eigen::Matrix2d covariance = information.inverse();
  const double age_s = covariance.row(0).dot(pull_);
  const double explained = age_s * age_s / covariance(0, 0);
  const double without_age = square_ - pull_(1) * pull_(1) / information(1, 1);
  const double left = std::max(1.0, (without_age - explained) / count_);
  const double sigma_s = std::sqrt(left * covariance(0, 0));
  const bool is_other =
      std::abs(age_s - known_s) > std::max(kLeastSetAnewS, kSetAnewSigmas * sigma_s);
  if (!is_other || explained < kExplainedShare * without_age) return {};
  return Age{age_s, sigma_s};
}

void VelocityChanges::take_out(double age_s) {
  square_ += age_s * (age_s * information_(0, 0) - 2.0 * pull_(0));
  pull_ -= age_s * information_.col(0);
}

}  // namespace leeway
