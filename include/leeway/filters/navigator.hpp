/// @file
/// The navigator: what vehicle software feeds with its drivers' data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "leeway/filters/alignment.hpp"
#include "leeway/filters/ekf.hpp"
#include "leeway/filters/time_to_limit.hpp"

namespace leeway {

/// What became of an input. Bad data is an outcome, not an error: it is counted and changes nothing
/// else, except that a gap in the IMU data is bridged.
enum class Verdict {
  kAccepted,     ///< IMU: integrated; GNSS: waits for the IMU data of its time
  kAligning,     ///< taken for alignment; there is no solution yet
  kFused,        ///< the fix corrected the state
  kGated,        ///< the fix was too far from the prediction for both to be right
  kGap,          ///< IMU data was missing for longer than max_gap_s: bridged by coasting
  kLate,         ///< the fix is older than the newest IMU data
  kDuplicate,    ///< same time as the newest of its kind
  kOutOfOrder,   ///< older than the newest of its kind
  kNotFinite,    ///< NaN or infinity
  kImplausible,  ///< beyond what the sensor can measure, or not a covariance
  kOverflow,     ///< more fixes wait for IMU data than there is room for
};

inline constexpr std::size_t kVerdicts = 11;

std::string_view name(Verdict verdict);

struct NavigatorConfig {
  EkfConfig filter{};
  AlignmentConfig alignment{};
  double max_gap_s{0.5};         ///< longer holes in the IMU data are coasted through
  double max_rate_radps{100.0};  ///< beyond this an IMU reading is implausible
  double max_force_mps2{1000.0};
};

/// Aligns, integrates, fuses. Inputs come in the order of their times; a fix may come up to any
/// time ahead of the IMU data that covers it, and acts at its own time, between samples. push
/// allocates nothing, throws nothing, logs nothing. A Navigator is a value: a copy goes its own
/// way.
class Navigator {
 public:
  /// @throws Error when the configuration is invalid.
  explicit Navigator(const NavigatorConfig& config);

  /// Starts from a known state instead of aligning. @throws Error when state or P is invalid.
  void start(const Estimate& estimate, const ErrorMatrix& P);

  Verdict push(const ImuIncrement& inc);
  Verdict push(const GnssFix& fix);

  bool aligned() const { return filter_.has_value(); }

  /// At the newest IMU time. @pre aligned().
  Solution solution() const;
  const Ekf& filter() const { return *filter_; }

  /// How long from the newest IMU time, without another fix, the horizontal error stays within the
  /// limit with the given probability (time_to_limit); 0 before alignment.
  TimeToLimit leeway(double limit_m, double probability = 0.95) const {
    return filter_ ? time_to_limit(*filter_, limit_m, probability) : TimeToLimit{};
  }

  /// The newest fix that reached the filter; dof 0 before the first.
  const UpdateReport& last_update() const { return last_update_; }

  std::uint64_t count(Verdict verdict) const { return counts_[static_cast<std::size_t>(verdict)]; }

 private:
  static constexpr std::size_t kMaxWaiting = 16;

  Verdict counted(Verdict verdict);
  Verdict take(const ImuIncrement& inc);
  void advance(const ImuIncrement& inc);
  GnssFix take_waiting();
  void apply(const GnssFix& fix);

  NavigatorConfig config_;
  Aligner aligner_;
  std::optional<Ekf> filter_{};
  std::optional<Time> imu_time_{};
  std::optional<Time> fix_time_{};
  std::array<GnssFix, kMaxWaiting> waiting_{};
  std::size_t waiting_count_{0};
  UpdateReport last_update_{};
  std::array<std::uint64_t, kVerdicts> counts_{};
};

}  // namespace leeway
