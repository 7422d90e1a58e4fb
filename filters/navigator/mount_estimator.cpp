#include "leeway/navigator/mount_estimator.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/model/heading.hpp"

namespace leeway {

void MountEstimator::push(const HeadingBank& bank) {
  constexpr double kLongestStepS = 1.0;
  const Ekf& filter = bank.best();
  const NavState& nav = filter.estimate().nav;
  const double step_s =
      previous_ ? std::min(to_seconds(nav.time - *previous_), kLongestStepS) : 0.0;
  previous_ = nav.time;
  const double speed_mps = nav.v_e_mps.norm();
  const Eigen::Vector3d rate =
      filter.inertial().mean_omega_ib_b_radps() - filter.estimate().bias.b_g_radps;
  if (speed_mps < kMinSpeedMps || rate.norm() > kMaxTurnRadps) return;
  const double variance_rad2 = heading_variance_rad2(filter.estimate(), bank.covariance());
  if (variance_rad2 > kMaxHeadingSigmaRad * kMaxHeadingSigmaRad) return;
  const Eigen::Quaterniond q_be = nav.q_eb.conjugate();
  forward_s_ += step_s * (q_be * (nav.v_e_mps / speed_mps));
  down_s_ += step_s * (q_be * down_e_at(nav.r_e_m));
  seen_s_ += step_s;
}

std::optional<Eigen::Matrix3d> MountEstimator::C_bs() const {
  if (seen_s_ < kEnoughS) return std::nullopt;
  const Eigen::Vector3d forward = forward_s_.normalized();
  const Eigen::Vector3d right = down_s_.cross(forward).normalized();
  Eigen::Matrix3d C_bs;
  C_bs << forward.transpose(), right.transpose(), forward.cross(right).transpose();
  return C_bs;
}

}  // namespace leeway
