#include "leeway/navigator/gate_recovery.hpp"

#include <Eigen/Core>

namespace leeway {
namespace {

constexpr std::uint32_t kWidenFrom = 3;
constexpr std::uint32_t kRestartFrom = 10;
constexpr std::uint32_t kLockOuts = 3;  // so many within so long: widening does not cure it
constexpr double kLockOutsWithinS = 120.0;
constexpr double kRelapseS = 60.0;              // after a restart; and of probation
constexpr std::uint32_t kTrustAgainAfter = 30;  // fixes fused in a row
constexpr double kUnknownVelocityMps = 30.0;

}  // namespace

GateRecovery::Remedy GateRecovery::refused(const GnssFix& fix) {
  fused_in_a_row_ = 0;
  if (in_a_row_++ == 0) since_ = fix.time;
  const Remedy remedy = remedy_for(fix);
  previous_ = fix;
  return remedy;
}

void GateRecovery::fused(const GnssFix& fix) {
  end();
  previous_ = fix;
  if (++fused_in_a_row_ < kTrustAgainAfter || !distrusts_imu_) return;
  distrusts_imu_ = false;
  on_probation_since_ = fix.time;
}

GateRecovery::Remedy GateRecovery::remedy_for(const GnssFix& fix) {
  const auto is_soon_after = [&fix](const std::optional<Time>& t) {
    return t && to_seconds(fix.time - *t) < kRelapseS;
  };
  if (in_a_row_ == kWidenFrom && is_soon_after(on_probation_since_)) distrusts_imu_ = true;
  if (distrusts_imu_ && previous_ && agree(*previous_, fix)) return Remedy::kRestart;
  if (in_a_row_ < kWidenFrom) return Remedy::kWait;
  if (in_a_row_ == kWidenFrom && comes_back(fix.time)) return Remedy::kRealign;
  if (in_a_row_ < kRestartFrom) return Remedy::kWiden;
  if (!fix.position) return Remedy::kWait;
  const bool relapse = is_soon_after(last_restart_);
  last_restart_ = fix.time;
  return relapse ? Remedy::kRealign : Remedy::kRestart;
}

bool GateRecovery::comes_back(Time t) {
  if (!first_lock_out_ || to_seconds(t - *first_lock_out_) > kLockOutsWithinS) {
    first_lock_out_ = t;
    lock_outs_ = 0;
  }
  return ++lock_outs_ >= kLockOuts;
}

void restart_motion(Ekf& filter, const GnssFix& fix) {
  const Eigen::Matrix3d unknown =
      kUnknownVelocityMps * kUnknownVelocityMps * Eigen::Matrix3d::Identity();
  edit(filter, [&](Belief& belief) {
    restart_motion(belief, fix.position->r_e_m, fix.position->R_e_m2,
                   fix.velocity ? fix.velocity->v_e_mps : belief.estimate.nav.v_e_mps,
                   fix.velocity ? fix.velocity->R_e_m2ps2 : unknown);
  });
}

}  // namespace leeway
