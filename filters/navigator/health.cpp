#include "leeway/navigator/health.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/navigator/navigator_state.hpp"

namespace leeway {
namespace {

constexpr double kDoubtS = 120.0;  // what is wrong in turns shows again at the next or so
constexpr double kBrokenImuScale = 5.0;  // beyond, the IMU cannot be what it is said to be

}  // namespace

Health NavigatorState::health(Time now) const {
  constexpr double kCoastingS = 2.0;
  Health health{.mount_known = C_bs_.has_value(),
                .at_rest = aiding_.at_rest(),
                .repairs = repairs_,
                .resets = resets_,
                .realignments = realignments_};
  if (!bank_) return health;
  const auto since = [now](const std::optional<Time>& then) {
    return then ? std::max(0.0, to_seconds(now - *then)) : 0.0;
  };
  health.coasting_s = since(last_fused_);
  health.gating_s = since(gate_recovery_.since());
  health.position_nis_ratio = position_noise_.nis_ratio();
  health.velocity_nis_ratio = velocity_noise_.nis_ratio();
  health.position_sigma_scale = position_noise_.sigma_scale();
  health.velocity_sigma_scale = velocity_noise_.sigma_scale();
  health.correlated_fixes =
      config_.filter.gnss_correlation_s == 0.0 && position_noise_.errors_last();
  health.optimistic_by =
      std::sqrt(std::max({1.0, health.position_nis_ratio, health.velocity_nis_ratio}));
  using State = Health::State;
  health.imu_sigma_scale = bank_->best().inertial().noise_scale();
  const bool was_contradicted = contradicted_ && to_seconds(now - *contradicted_) < kDoubtS;
  const bool is_inconsistent = was_contradicted || health.imu_sigma_scale > kBrokenImuScale ||
                               position_noise_.is_inconsistent() ||
                               velocity_noise_.is_inconsistent();
  health.state = gate_recovery_.is_row()          ? State::kGating
                 : health.coasting_s > kCoastingS ? State::kCoasting
                 : !bank_->collapsed()            ? State::kHeadingOpen
                 : is_inconsistent                ? State::kInconsistent
                                                  : State::kAligned;
  return health;
}

}  // namespace leeway
