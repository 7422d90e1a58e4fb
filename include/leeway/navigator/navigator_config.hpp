/// @file
/// Everything a navigator can be told about its sensors and its vehicle.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/fields.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/navigator/alignment.hpp"
#include "leeway/navigator/vehicle_aiding.hpp"
#include "leeway/sensors/imu.hpp"

namespace leeway {

/// When measurements were valid, when they may arrive, and how much memory waiting for them takes.
struct TimingConfig {
  /// A position is that of this long before the time of its fix, a velocity likewise: a receiver
  /// that reports the mean velocity of an epoch has half an epoch here.
  double position_lag_s{0.0};
  double velocity_lag_s{0.0};
  /// Takes the offset between the clocks of receiver and IMU out, once health tells of one. The
  /// solution then depends on when fixes arrive, too.
  bool estimate_clock{false};
  double max_lateness_s{2.0};  ///< an input may arrive this long after IMU data of its time
  double max_ahead_s{10.0};    ///< a measurement further ahead of the IMU data is from the future
  double max_imu_rate_hz{400.0};  ///< at more than this the lateness that fits shrinks

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"position_lag_s", c.position_lag_s, between(-10.0, 10.0)},
                   Field{"velocity_lag_s", c.velocity_lag_s, between(-10.0, 10.0)},
                   Field{"estimate_clock", c.estimate_clock},
                   Field{"max_lateness_s", c.max_lateness_s, between(0.0, 60.0)},
                   Field{"max_ahead_s", c.max_ahead_s, between(0.0, 1e4)},
                   Field{"max_imu_rate_hz", c.max_imu_rate_hz, between(1.0, 1e4)});
  }
};

/// The defaults suit a car whose IMU axes are forward, right, down.
struct NavigatorConfig {
  EkfConfig filter{};
  AlignmentConfig alignment{};
  VehicleConfig vehicle{};
  TimingConfig timing{};
  /// Sensor axes to body axes (forward, right, down). Nothing: estimated from gravity and the way
  /// the vehicle goes; until then, body axes are sensor axes.
  std::optional<Eigen::Matrix3d> C_bs{Eigen::Matrix3d::Identity()};
  RateMeaning rate_meaning{RateMeaning::kPoint};  ///< of an ImuSample
  double max_gap_s{0.5};                          ///< longer holes in the IMU data are bridged
  /// A longer step of the IMU's time is a jump of its clock, a longer increment implausible.
  double max_jump_s{60.0};
  double max_rate_radps{100.0};  ///< beyond this an IMU reading is implausible
  double max_force_mps2{1000.0};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"filter", c.filter}, Field{"alignment", c.alignment},
                   Field{"vehicle", c.vehicle}, Field{"timing", c.timing}, Field{"C_bs", c.C_bs},
                   Field{"rate_meaning", c.rate_meaning},
                   Field{"max_gap_s", c.max_gap_s, positive_to(10.0)},
                   Field{"max_jump_s", c.max_jump_s, positive_to(1e5)},
                   Field{"max_rate_radps", c.max_rate_radps, kPositiveOrInfinite},
                   Field{"max_force_mps2", c.max_force_mps2, kPositiveOrInfinite});
  }
};

/// @throws Error when a value is out of range: the field, its value, the allowed range.
void validate(const NavigatorConfig& config);

}  // namespace leeway
