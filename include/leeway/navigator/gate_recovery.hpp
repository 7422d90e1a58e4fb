/// @file
/// A refused fix is a question with two answers: the fix is wrong, or the filter is.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/time.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/navigator/vehicle_kind.hpp"
#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// Factor on an IMU's noise beyond which it is no IMU of its kind.
inline constexpr double kLargestImuScale = 300.0;

/// Decides which refused fixes may be true. It weighs them against what the vehicle can have done
/// since the last good one, and against how long each side has been consistent: by times and
/// distances, so that the answer is the same at 0.1 and at 20 s between fixes. No heap, no
/// exceptions. Source: docs/theory/navigator/gate_recovery.md.
class GateRecovery {
 public:
  explicit GateRecovery(const VehicleLimits& limits) : limits_(limits) {}

  /// The gate has refused a fix.
  /// @param position_alone  its velocity is the filter's, as refuses_position_alone()
  /// @returns odds of the fix to the filter, before later fixes are heard; 0: it cannot be true
  double odds_of(const GnssFix& fix, bool position_alone = false);

  /// A fix was fused.
  void fused(const GnssFix& fix, const Ekf& filter);

  /// Motion began anew: nothing from before counts.
  void begin(Time t);

  /// Whether the newest fix was refused.
  bool is_row() const { return refused_since_.has_value(); }

  /// Whether the newest refused fix agrees with one refused before it.
  bool is_repeated() const { return rival_ && rival_->time > *rival_since_; }

  /// The first of the fixes refused in a row.
  const std::optional<Time>& since() const { return refused_since_; }

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(good_time_, good_r_e_m_, good_v_e_mps_, good_sigma_m_, good_sigma_mps_, good_since_,
            refused_since_, rival_since_, rival_);
  }

 private:
  bool is_reachable(const GnssFix& fix) const;
  bool continues_rival(const GnssFix& fix) const;

  VehicleLimits limits_;
  std::optional<Time> good_time_{};  // of the last fix that was fused, and the filter's state then
  Eigen::Vector3d good_r_e_m_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d good_v_e_mps_{Eigen::Vector3d::Zero()};
  double good_sigma_m_{0.0};
  double good_sigma_mps_{0.0};
  Time good_since_{};
  std::optional<Time> refused_since_{};
  std::optional<Time> rival_since_{};  // of the refused fixes that agree with each other
  std::optional<GnssFix> rival_{};
};

/// Whether the fix's velocity was fused and its position was not: neither attitude nor IMU is in
/// doubt.
bool refuses_position_alone(const UpdateOutcome& refusal);

/// The filter as it is if the fix is right. Where the position alone was refused, that begins anew.
/// Else position and velocity do, as the fix has them, and attitude, biases and IMU are less
/// certain, by as much as the refusal suggests. A velocity that the fix lacks is the filter's own,
/// with as much sigma as the vehicle can have changed it by.
/// @param unseen_mps  1 sigma of that
/// @pre fix.position, and is_usable(fix).
Ekf rival_of(const Ekf& filter, const GnssFix& fix, const UpdateOutcome& refusal,
             double unseen_mps);

}  // namespace leeway
