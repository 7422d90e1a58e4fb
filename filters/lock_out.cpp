#include "leeway/filters/lock_out.hpp"

#include <Eigen/Core>

namespace leeway {
namespace {

constexpr std::uint32_t kWidenFrom = 3;
constexpr std::uint32_t kRestartFrom = 10;
constexpr std::uint32_t kLockOuts = 3;  // so many within so long: widening does not cure it
constexpr double kLockOutsWithinS = 120.0;
constexpr double kRelapseS = 60.0;  // after a restart
constexpr double kUnknownVelocityMps = 30.0;

}  // namespace

LockOut::Remedy LockOut::refused(Time t, bool has_position) {
  if (in_a_row_++ == 0) since_ = t;
  if (in_a_row_ < kWidenFrom) return Remedy::kWait;
  if (in_a_row_ == kWidenFrom && comes_back(t)) return Remedy::kRealign;
  if (in_a_row_ < kRestartFrom) return Remedy::kWiden;
  if (!has_position) return Remedy::kWait;
  const bool relapse = last_restart_ && to_seconds(t - *last_restart_) < kRelapseS;
  last_restart_ = t;
  return relapse ? Remedy::kRealign : Remedy::kRestart;
}

bool LockOut::comes_back(Time t) {
  if (!first_lock_out_ || to_seconds(t - *first_lock_out_) > kLockOutsWithinS) {
    first_lock_out_ = t;
    lock_outs_ = 0;
  }
  return ++lock_outs_ >= kLockOuts;
}

void restart_motion(Ekf& filter, const GnssFix& fix) {
  const Eigen::Matrix3d unknown =
      kUnknownVelocityMps * kUnknownVelocityMps * Eigen::Matrix3d::Identity();
  filter.restart_motion(fix.position->r_e_m, fix.position->R_e_m2,
                        fix.velocity ? fix.velocity->v_e_mps : filter.estimate().nav.v_e_mps,
                        fix.velocity ? fix.velocity->R_e_m2ps2 : unknown);
}

}  // namespace leeway
