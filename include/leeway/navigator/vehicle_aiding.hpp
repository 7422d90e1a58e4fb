/// @file
/// What is known of a vehicle without asking a receiver: that it stands, that it does not slide.
#pragma once

#include <algorithm>
#include <cmath>

#include "leeway/earth/fields.hpp"
#include "leeway/model/vehicle_state.hpp"
#include "leeway/monitors/nis_cusum.hpp"
#include "leeway/monitors/standstill.hpp"
#include "leeway/navigator/heading_bank.hpp"
#include "leeway/navigator/vehicle_kind.hpp"

namespace leeway {

/// Each part but the heading is off unless switched on; car() is the set for a road vehicle. Sigmas
/// of constraints stand for errors that last, fused twice a second as if they were white: they are
/// larger than what the innovations show (docs/theory/navigator/vehicle_aiding.md).
struct VehicleConfig {
  VehicleKind kind{VehicleKind::kNone};
  bool zero_velocity{false};
  bool zero_angular_rate{false};
  bool non_holonomic{false};
  bool odometer{false};
  bool barometer{false};
  bool heading{true};  ///< measured: it needs nothing of the vehicle

  StandstillConfig standstill{};
  double rest_sigma_mps{0.05};         ///< velocity at rest: the body on its springs
  double rest_turn_sigma_radps{2e-5};  ///< rate at rest, beyond the gyro's white noise
  double min_speed_mps{2.0};           ///< below it the constraint says little of the heading
  double right_sigma_mps{0.06};        ///< velocity of the rear axle to the right ...
  double right_sigma_m{1.0};           ///< ... and more by this times the rate of turn: slip
  double down_sigma_m2ps2{1.2};        ///< times 1 / speed: its velocity downwards, brakes, humps
  double rear_axle_x_m{-1.3};          ///< IMU to rear axle along the body's x axis
  double rear_axle_sigma_m{0.5};
  double mount_sigma_rad{0.05};  ///< pitch and yaw of the mount
  double mount_walk_rad_per_sqrt_s{2e-5};
  double odometer_scale_sigma{0.03};
  double odometer_walk_per_sqrt_s{1e-5};
  double height_offset_sigma_m{100.0};
  double height_walk_m_per_sqrt_s{0.05};  ///< weather

  /// A road vehicle: at rest when it rests, and never sideways. Odometer and barometer are used if
  /// there are any.
  static VehicleConfig car();

  /// The set for a vehicle of this kind. Constraints are known for a car alone.
  static VehicleConfig of(VehicleKind kind);

  /// Whether a part that is on depends on the vehicle's parameters.
  bool uses_parameters() const { return non_holonomic || odometer || barometer; }

  static auto visit(auto& c, const auto& visitor) {
    return visitor(
        Field{"kind", c.kind}, Field{"zero_velocity", c.zero_velocity},
        Field{"zero_angular_rate", c.zero_angular_rate}, Field{"non_holonomic", c.non_holonomic},
        Field{"odometer", c.odometer}, Field{"barometer", c.barometer}, Field{"heading", c.heading},
        Field{"standstill", c.standstill}, Field{"rest_sigma_mps", c.rest_sigma_mps, kPositive},
        Field{"rest_turn_sigma_radps", c.rest_turn_sigma_radps, kPositive},
        Field{"min_speed_mps", c.min_speed_mps, kPositive},
        Field{"right_sigma_mps", c.right_sigma_mps, kPositive},
        Field{"right_sigma_m", c.right_sigma_m, kNotNegative},
        Field{"down_sigma_m2ps2", c.down_sigma_m2ps2, kPositive},
        Field{"rear_axle_x_m", c.rear_axle_x_m, between(-100.0, 100.0)},
        Field{"rear_axle_sigma_m", c.rear_axle_sigma_m, kNotNegative},
        Field{"mount_sigma_rad", c.mount_sigma_rad, kNotNegative},
        Field{"mount_walk_rad_per_sqrt_s", c.mount_walk_rad_per_sqrt_s, kNotNegative},
        Field{"odometer_scale_sigma", c.odometer_scale_sigma, kNotNegative},
        Field{"odometer_walk_per_sqrt_s", c.odometer_walk_per_sqrt_s, kNotNegative},
        Field{"height_offset_sigma_m", c.height_offset_sigma_m, kNotNegative},
        Field{"height_walk_m_per_sqrt_s", c.height_walk_m_per_sqrt_s, kNotNegative});
  }
};

/// 1 sigma of the rear axle's velocity to the right, at a rate of turn ...
inline double right_sigma_mps(const VehicleConfig& config, double turn_radps) {
  return std::hypot(config.right_sigma_mps, config.right_sigma_m * turn_radps);
}

/// ... and down, at a speed above 0.
inline double down_sigma_mps(const VehicleConfig& config, double speed_mps) {
  return config.down_sigma_m2ps2 / speed_mps;
}

/// 1 sigma of a mean rate at rest over a time, of a gyro with this density of white noise.
inline double rest_turn_sigma_radps(const VehicleConfig& config, double gyro_noise_rad_per_sqrt_s,
                                    double dt_s) {
  return std::hypot(gyro_noise_rad_per_sqrt_s / std::sqrt(dt_s), config.rest_turn_sigma_radps);
}

/// Whether a fix can tell no heading. At constant velocity as at rest the specific force is along
/// gravity: neither heading nor the gyro's bias about the vertical shows. What a turn has shown
/// takes a few fixes to be read.
/// @param even_s  how long the velocity has been constant
inline bool motion_hides_heading(const VehicleConfig& config, bool at_rest, double even_s,
                                 double fix_interval_s) {
  constexpr double kReadS = 10.0;
  constexpr double kReadFixes = 3.0;
  return at_rest ||
         (!config.non_holonomic && even_s > std::max(kReadS, kReadFixes * fix_interval_s));
}

/// @throws Error when a value is out of range.
void validate(const VehicleConfig& config);

/// The vehicle's parameters as far as the configuration knows them.
VehicleState vehicle_state(const VehicleConfig& config);

/// Watches the IMU and tells the filter, twice a second, what follows from the vehicle being one.
/// No heap, no exceptions after construction.
class VehicleAiding {
 public:
  /// @throws Error when a value is out of range.
  VehicleAiding(const VehicleConfig& config, const ImuErrorModel& imu);

  /// Right after the filters have been advanced by inc.
  /// @returns whether the constraints contradict the only filter, beyond chance
  bool push(const ImuIncrement& inc, HeadingBank& bank);

  bool at_rest() const { return at_rest_; }

  /// How long the horizontal acceleration has been no more than its own uncertainty, s.
  double even_motion_s() const { return even_motion_s_; }

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(blocks_, standstill_, at_rest_, even_motion_s_, cusum_);
  }

 private:
  void rest(const ImuBlock& block, HeadingBank& bank) const;
  double roll(const ImuBlock& block, HeadingBank& bank) const;

  VehicleConfig config_;
  double gyro_noise_rad_per_sqrt_s_;
  ImuBlocks blocks_{};
  StandstillDetector standstill_;
  bool at_rest_{false};
  double even_motion_s_{0.0};
  NisCusum cusum_{};
};

}  // namespace leeway
