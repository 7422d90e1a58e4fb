#include "leeway/monitors/fix_screen.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"

namespace leeway {
namespace {

constexpr double kMovesMps = 0.5;
constexpr double kLeastM = 1e-3;  // carrier phase noise: a hundredth of 19 cm
constexpr double kLeastMps = 1e-3;

/// Latitude and longitude zero to a centimetre.
bool is_null_island(const Eigen::Vector3d& r_e_m) {
  constexpr double kSameM = 0.01;
  return std::abs(r_e_m.y()) < kSameM && std::abs(r_e_m.z()) < kSameM && r_e_m.x() > 0.0;
}

/// Raises R as a whole when one of its axes falls below the floor, which follows the claims.
void raise(Eigen::Matrix3d& R, double least, double& floor) {
  constexpr double kImprovement = 3.0;  // from fix to fix
  constexpr double kDecline = 2.0;      // one bad claim does not spoil the good ones after it
  const double claimed = std::sqrt(std::max(0.0, R.diagonal().minCoeff()));
  const double believed = std::max({claimed, least, floor});
  if (believed > claimed) {
    R += (believed * believed - claimed * claimed) * Eigen::Matrix3d::Identity();
  }
  const double highest = floor > 0.0 ? kDecline * kImprovement * floor : believed;
  floor = std::min(believed, highest) / kImprovement;
}

}  // namespace

FixScreen::Finding FixScreen::judge(const GnssFix& fix, bool moves) {
  if (fix.position && is_null_island(fix.position->r_e_m)) return Finding::kNone;
  const bool claims_motion = fix.velocity && fix.velocity->v_e_mps.norm() > kMovesMps;
  const bool same_position =
      !fix.position || (position_ && *position_ == fix.position->r_e_m);
  const bool same_velocity =
      !fix.velocity || (velocity_ && *velocity_ == fix.velocity->v_e_mps);
  if (same_position && same_velocity && (moves || claims_motion)) return Finding::kRepeated;
  if (fix.position) position_ = fix.position->r_e_m;
  if (fix.velocity) velocity_ = fix.velocity->v_e_mps;
  return Finding::kNews;
}

GnssFix FixScreen::with_floor(const GnssFix& fix) {
  GnssFix result = fix;
  if (fix.position) raise(result.position->R_e_m2, kLeastM, floor_m_);
  if (fix.velocity) raise(result.velocity->R_e_m2ps2, kLeastMps, floor_mps_);
  return result;
}

}  // namespace leeway
