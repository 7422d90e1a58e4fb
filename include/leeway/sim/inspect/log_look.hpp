/// @file
/// What is in logs: their figures, and findings on what is wrong with them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "leeway/earth/names.hpp"

namespace leeway::sim {

/// Certainty of a finding. A certain one leaves no second explanation.
enum class Certainty { kNote, kLikely, kCertain };
constexpr auto names(Certainty) { return std::array{"note", "likely", "certain"}; }

/// One thing that a log says of itself or that two logs say of each other.
struct Finding {
  Certainty certainty{};
  std::string log{};     ///< "imu", "gnss" or the name of an aiding sensor
  std::string about{};   ///< for scripts: "accelerometer-unit"
  std::string text{};    ///< the figure, and why it is wrong
  std::string remedy{};  ///< the option that mends it; empty: there is none
};

inline constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();

/// Figures of the times of a log.
struct TimeFigures {
  std::int64_t records{0};
  double first_s{kUnseen};
  double last_s{kUnseen};
  double step_s{kUnseen};    ///< the usual time between two records, the median of the first 1000
  double jitter_s{kUnseen};  ///< root mean square of the steps about it, gaps and bursts aside
  std::int64_t gaps{0};      ///< steps above 1.5 of it
  double longest_gap_s{0.0};
  std::int64_t bursts{0};    ///< steps below half of it
  std::int64_t sessions{1};  ///< parted by a minute without a record
};

/// Figures of an IMU log, in the axes of the increments.
struct ImuFigures {
  TimeFigures time{};
  double specific_force_mps2{kUnseen};  ///< median of the magnitudes of means over a second
  Eigen::Vector3d up_b{Eigen::Vector3d::Constant(kUnseen)};  ///< unit vector, the mean one
  /// Magnitude of the mean specific force over the mean magnitude: 1 where its direction stays.
  double steadiness{kUnseen};
  /// Unit vector: where the log gains speed. NaN without speed changes to see it by.
  Eigen::Vector3d forward_b{Eigen::Vector3d::Constant(kUnseen)};
  /// Channels x, y, z of the gyros, then of the accelerometers, that never change.
  std::array<bool, 6> is_stuck{};
  /// Samples at the largest magnitude of their sensor, where it is one of a full scale.
  std::int64_t saturated{0};
};

/// Figures of a GNSS log.
struct FixFigures {
  TimeFigures time{};
  std::int64_t with_velocity{0};
  std::int64_t repeated{0};        ///< that repeat the one before to the bit
  std::int64_t zeros{0};           ///< at 0 deg, 0 deg
  double fastest_mps{0.0};         ///< horizontally, by velocities or else by positions
  double claimed_h_m{kUnseen};     ///< mean standard deviation of an axis, horizontal
  double scatter_h_m{kUnseen};     ///< of an axis, from one fix to the next, motion taken out
  double wander_h_m{kUnseen};      ///< the same over ten seconds
  double velocity_lag_s{kUnseen};  ///< how late velocities are against positions
  double velocity_lag_sigma_s{kUnseen};
  double velocity_lag_share{0.0};  ///< of what positions and velocities differ by that it explains
};

/// Figures of turns and speeds that two logs share.
struct SharedFigures {
  double clock_offset_s{kUnseen};  ///< to be added to GNSS times
  double clock_offset_sigma_s{kUnseen};
  double turn_correlation{0.0};  ///< at that offset, signed
  double turn_ratio{kUnseen};    ///< turn of the course over that of the gyros, about down
  double turn_ratio_sigma{kUnseen};
  double antenna_lead_m{kUnseen};  ///< ahead of the point that does not slide sideways
  double odometer_ratio{kUnseen};  ///< odometer over GNSS speed
};

/// All of it.
struct LogLook {
  ImuFigures imu{};
  FixFigures gnss{};
  SharedFigures shared{};
  std::vector<Finding> findings{};  ///< the certain ones first

  bool is_certainly_wrong() const;
};

}  // namespace leeway::sim
