/// @file
/// What a navigator carries through time: alignment, filter, aiding and their monitors, fed in the
/// order of time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "leeway/navigator/aidings.hpp"
#include "leeway/navigator/alignment.hpp"
#include "leeway/monitors/coast_monitor.hpp"
#include "leeway/monitors/course_monitor.hpp"
#include "leeway/monitors/fix_screen.hpp"
#include "leeway/navigator/gate_recovery.hpp"
#include "leeway/navigator/heading_bank.hpp"
#include "leeway/navigator/health.hpp"
#include "leeway/monitors/imu_screen.hpp"
#include "leeway/navigator/measured_heading.hpp"
#include "leeway/navigator/mount_estimator.hpp"
#include "leeway/navigator/navigator_config.hpp"
#include "leeway/monitors/receiver_noise.hpp"
#include "leeway/navigator/vehicle_aiding.hpp"
#include "leeway/navigator/verdict.hpp"

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
  Verdict fuse(const Reading& reading);

  bool aligned() const { return bank_.has_value(); }

  /// @pre aligned().
  const HeadingBank& bank() const { return *bank_; }

  /// Sensor axes to body axes, as far as known.
  const std::optional<Eigen::Matrix3d>& C_bs() const { return C_bs_; }

  /// The newest fix that reached the filter; dof 0 before the first.
  const UpdateOutcome& last_update() const { return last_update_; }

  /// @param now  that integrate() and bridge() have reached
  Health health(Time now) const;

  /// Adds to the covariance of every filter. @pre aligned().
  void widen(const ErrorMatrix& covariance);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(imu_screen_, hole_s_, screen_, aligner_, aiding_, course_, mount_, position_noise_,
            velocity_noise_, C_bs_, last_update_, last_fused_, gate_recovery_, incumbent_,
            heading_weight_, refused_headings_, heading_doubted_, contradicted_,
            is_starting_beside_, repairs_, resets_, realignments_);
    const HeadingBank any = any_bank();
    archive.optional(bank_, any);
    coast_.visit(archive, any.best());
  }

 private:
  HeadingBank any_bank() const;
  Verdict take(const GnssFix& fix);
  Verdict use(const GnssFix& fix);
  UpdateOutcome update(Ekf& filter, const GnssFix& fix) const;
  template <AidingReading R>
  Verdict take(const R& reading);
  Verdict take(const MeasuredHeading& heading);
  void doubt_heading_by(const MeasuredHeading& heading);
  void align(const GnssFix& fix);
  void begin(const HeadingBank& bank);
  void begin_vehicle();
  void find_mount();
  void end_hole();
  void open_heading();
  Verdict settle(const GnssFix& fix, bool is_explained);
  bool is_white(const GnssFix& fix) const;
  void learn_noise(const GnssFix& fix);
  void challenge(const GnssFix& fix, double odds);
  void watch_course(const GnssFix& fix);
  void start_beside(const GnssFix& fix, double fix_interval_s);
  bool was_opened(Time now) const;
  bool doubt_heading(Ekf around, const Ekf& doubting);
  void learn_imu_noise(const GnssFix& fix);
  void watch_coasting();
  bool moves() const;
  bool motion_hides_heading(Time t) const;
  void realign();

  // What it was chosen by: docs/theory/navigator/measured_heading.md.
  static constexpr double kHeadingCorrelationS = 10.0;

  NavigatorConfig config_;
  ImuScreen imu_screen_{};
  double hole_s_{0.0};  // without IMU data, up to now
  FixScreen screen_{};
  Aligner aligner_;
  VehicleAiding aiding_;
  CourseMonitor course_;
  CoastMonitor coast_{};
  MountEstimator mount_{};
  ReceiverNoise position_noise_{1.0, false};  // its errors are those of the fix before
  // A third: some state for each axis what is of all three, or the double of it.
  ReceiverNoise velocity_noise_{1.0 / 3.0, true};
  std::optional<Eigen::Matrix3d> C_bs_;
  std::optional<HeadingBank> bank_{};
  UpdateOutcome last_update_{};
  std::optional<Time> last_fused_{};  // fix
  GateRecovery gate_recovery_;
  std::size_t incumbent_{0};  // the best filter before the fixes that are refused
  PositionWeight heading_weight_{kHeadingCorrelationS};
  RefusedHeadings refused_headings_{};
  std::optional<Time> heading_doubted_{};
  std::optional<Time> contradicted_{};  // the filter, by what it cannot explain
  bool is_starting_beside_{false};  // the aligner, anew
  std::uint32_t repairs_{0};
  std::uint32_t resets_{0};
  std::uint32_t realignments_{0};
};

}  // namespace leeway
