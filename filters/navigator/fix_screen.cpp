#include "leeway/navigator/fix_screen.hpp"

#include <cmath>

#include "leeway/earth/earth.hpp"

namespace leeway {
namespace {

constexpr double kMovesMps = 0.5;
constexpr double kFloorM = 1e-3;  // carrier phase noise: a hundredth of 19 cm
constexpr double kFloorMps = 1e-3;

/// Latitude and longitude zero to a centimetre.
bool is_null_island(const Eigen::Vector3d& r_e_m) {
  constexpr double kSameM = 0.01;
  return std::abs(r_e_m.y()) < kSameM && std::abs(r_e_m.z()) < kSameM && r_e_m.x() > 0.0;
}

/// R, raised as a whole when one of its axes falls below the floor.
Eigen::Matrix3d raised(const Eigen::Matrix3d& R, double floor) {
  if (R.diagonal().minCoeff() >= floor * floor) return R;
  return R + floor * floor * Eigen::Matrix3d::Identity();
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

GnssFix with_floor(const GnssFix& fix) {
  GnssFix result = fix;
  if (result.position) result.position->R_e_m2 = raised(result.position->R_e_m2, kFloorM);
  if (result.velocity) result.velocity->R_e_m2ps2 = raised(result.velocity->R_e_m2ps2, kFloorMps);
  return result;
}

}  // namespace leeway
