/// @file
/// What a navigator carries through time: alignment, filter, aiding and their monitors, fed in the
/// order of time.
#pragma once

#include <cstdint>
#include <optional>

#include "leeway/navigator/alignment.hpp"
#include "leeway/navigator/gate_recovery.hpp"
#include "leeway/navigator/heading_bank.hpp"
#include "leeway/navigator/mount_estimator.hpp"
#include "leeway/navigator/navigator_config.hpp"
#include "leeway/navigator/receiver_noise.hpp"
#include "leeway/navigator/vehicle_aiding.hpp"
#include "leeway/navigator/verdict.hpp"
#include "leeway/sensors/vehicle_sensors.hpp"

namespace leeway {

/// The state behind a Navigator, without its queues: a value, so that a copy is a point in time to
/// come back to. Nothing allocates or throws after construction; same inputs give the same bits.
class NavigatorState {
 public:
  /// @throws Error when the configuration is invalid.
  explicit NavigatorState(const NavigatorConfig& config);

  /// From a known state; a heading with more than 15 deg of sigma becomes a bank of headings.
  /// @throws Error when state or P is invalid.
  void start(const Estimate& estimate, const ErrorMatrix& P);

  /// @param inc  in sensor axes. @pre it follows what was integrated before.
  void integrate(const ImuIncrement& inc);

  /// Over time without IMU data. @pre to is later than what was integrated before.
  void bridge(Time to);

  /// At the time that integrate() and bridge() have reached. @pre is_usable.
  Verdict fuse(const GnssFix& fix);
  Verdict fuse(const OdometerSpeed& odometer);
  Verdict fuse(const BarometricHeight& barometer);

  bool aligned() const { return bank_.has_value(); }

  /// @pre aligned().
  const HeadingBank& bank() const { return *bank_; }

  /// Sensor axes to body axes, as far as known.
  const std::optional<Eigen::Matrix3d>& C_bs() const { return C_bs_; }

  const UpdateOutcome& last_update() const { return last_update_; }
  const std::optional<Time>& last_fused() const { return last_fused_; }
  const std::optional<Time>& gated_since() const { return gate_recovery_.since(); }
  const ReceiverNoise& position_noise() const { return position_noise_; }
  const ReceiverNoise& velocity_noise() const { return velocity_noise_; }
  bool at_rest() const { return aiding_.at_rest(); }
  bool distrusts_imu() const { return gate_recovery_.distrusts_imu(); }
  std::uint32_t repairs() const { return repairs_; }
  std::uint32_t resets() const { return resets_; }
  std::uint32_t realignments() const { return realignments_; }

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(aligner_, aiding_, mount_, position_noise_, velocity_noise_, C_bs_, last_update_,
            last_fused_, gate_recovery_, repairs_, resets_, realignments_);
    const Ekf filter = any_filter();
    bool has_bank = bank_.has_value();
    archive(has_bank);
    HeadingBank bank = bank_ ? *bank_ : HeadingBank(filter);
    bank.visit(archive, filter);
    bank_ = has_bank ? std::optional(bank) : std::nullopt;
  }

 private:
  void align(const GnssFix& fix);
  void begin(const HeadingBank& bank);
  void begin_vehicle();
  void find_mount();
  void open_heading();
  Verdict settle(const GnssFix& fix);
  void note_fused(Time t);
  void follow_drift();
  template <class F>
  Verdict aid(bool is_on, F&& measurement);
  Verdict locked_out(const GnssFix& fix);
  void realign();
  void guard_numbers();
  void watch_covariance();
  Ekf any_filter() const;

  NavigatorConfig config_;
  Aligner aligner_;
  VehicleAiding aiding_;
  MountEstimator mount_{};
  ReceiverNoise position_noise_{1.0};  // its errors are those of the fix before
  ReceiverNoise velocity_noise_{0.5};
  std::optional<Eigen::Matrix3d> C_bs_;
  std::optional<HeadingBank> bank_{};
  UpdateOutcome last_update_{};
  std::optional<Time> last_fused_{};  // fix
  GateRecovery gate_recovery_{};
  std::uint32_t repairs_{0};
  std::uint32_t resets_{0};
  std::uint32_t realignments_{0};
};

}  // namespace leeway
