/// @file
/// The navigator: what vehicle software feeds with its drivers' data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "leeway/ekf/time_to_limit.hpp"
#include "leeway/monitors/clock_monitor.hpp"
#include "leeway/navigator/aidings.hpp"
#include "leeway/navigator/health.hpp"
#include "leeway/navigator/imu_clock.hpp"
#include "leeway/navigator/navigator_config.hpp"
#include "leeway/navigator/snapshot.hpp"
#include "leeway/navigator/timeline.hpp"
#include "leeway/navigator/verdict.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/strapdown/solution.hpp"

namespace leeway {

/// Aligns, integrates, fuses. IMU data comes in the order of its time; measurements come in any
/// order, up to max_lateness_s late or max_ahead_s early, and act at their own time, between
/// samples: the solution does not depend on when they arrive. push allocates nothing, throws
/// nothing, logs nothing, and its answer is counted. A Navigator is a value: a copy goes its own
/// way, and allocates.
class Navigator {
 public:
  /// @throws Error when the configuration is invalid.
  explicit Navigator(const NavigatorConfig& config);

  /// Starts from a known state instead of aligning. A heading sigma above 15 deg becomes a bank of
  /// headings. @throws Error when state or P is invalid; then nothing has changed.
  void start(const Estimate& estimate, const ErrorMatrix& P);

  /// Sensor axes. Either increments or samples, not both by turns.
  Verdict push(const ImuIncrement& inc);
  Verdict push(const ImuSample& sample);

  /// A GnssFix, or what another sensor reads (aidings.hpp).
  Verdict push(const Reading& reading);

  bool aligned() const { return state().aligned(); }

  /// At the newest IMU time, with one sigma. @pre aligned().
  Solution solution() const;

  /// The filter, the likeliest one while several headings are possible. @pre aligned().
  const Ekf& filter() const { return state().bank().best(); }

  /// How long from the newest IMU time, without another fix, the horizontal error stays within the
  /// limit with the given probability (time_to_limit); 0 before alignment.
  TimeToLimit leeway(double limit_m, double probability = 0.95) const;

  /// Sensor axes to body axes; nothing while the mount is unknown.
  const std::optional<Eigen::Matrix3d>& C_bs() const { return state().C_bs(); }

  Health health() const;

  /// The newest fix that reached the filter; dof 0 before the first.
  const UpdateOutcome& last_update() const { return state().last_update(); }

  std::uint64_t count(Verdict verdict) const;

  /// How many bytes a snapshot has; the same at any time for a configuration.
  std::size_t snapshot_size() const;

  /// Writes the state. Continued from it, the same inputs give the same bits. Unlike push this
  /// allocates, and takes a millisecond.
  /// @pre out.size() == snapshot_size().
  void snapshot(std::span<std::byte> out) const;

  /// Takes the state of a navigator of the same configuration, on the same kind of machine.
  Restore restore(std::span<const std::byte> bytes);

 private:
  template <class Archive>
  void visit(Archive& archive) {
    archive(timeline_, clock_, receiver_clock_, sample_, newest_, carried_, counts_);
  }

  const NavigatorState& state() const { return timeline_.state(); }
  Verdict counted(Verdict verdict);
  Verdict take(const ImuIncrement& inc);
  void carry_over(const ImuIncrement& inc);
  void add_carried(ImuIncrement& inc, double dt_s);
  Verdict take(const ImuSample& sample);
  Verdict take(const GnssFix& fix);
  Verdict take(const Event& event);
  void watch_clock(const Step& step);

  NavigatorConfig config_;
  Timeline timeline_;
  ImuClock clock_;
  ClockMonitor receiver_clock_;
  std::optional<ImuSample> sample_{};
  std::optional<ImuIncrement> newest_{};
  std::optional<ImuIncrement> carried_{};  // waits for the next one
  std::array<std::uint64_t, kVerdicts> counts_{};
};

}  // namespace leeway
