/// @file
/// Whether the vehicle stands still, told from the IMU's vibration, its mean rate and the filter's
/// velocity.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/fields.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/sensors/imu.hpp"

namespace leeway {

/// The defaults suit a car with MEMS sensors: an idling engine stays below the vibration, creeping
/// at walking pace stays above it (docs/theory/navigator/vehicle_aiding.md).
struct StandstillConfig {
  double gyro_std_radps{0.002};  ///< largest norm of the standard deviations within a block
  double force_std_mps2{0.06};
  double turn_radps{0.005};  ///< largest mean rate beyond the gyro bias: refuses slow smooth turns
  /// Largest mean acceleration, two sigma of the filter's attitude and bias beyond: an even
  /// slowdown is as quiet as a rest.
  double acceleration_mps2{0.2};
  /// Largest speed, three sigma of the filter's velocity beyond, up to 3 m/s.
  double speed_mps{0.3};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"gyro_std_radps", c.gyro_std_radps, kPositive},
                   Field{"force_std_mps2", c.force_std_mps2, kPositive},
                   Field{"turn_radps", c.turn_radps, kPositive},
                   Field{"acceleration_mps2", c.acceleration_mps2, kPositive},
                   Field{"speed_mps", c.speed_mps, kPositive});
  }
};

/// Mean and spread of the IMU over a block of time.
struct ImuBlock {
  Time time{};  ///< its end
  double dt_s{0.0};
  Eigen::Vector3d mean_omega_ib_b_radps{Eigen::Vector3d::Zero()};
  Eigen::Vector3d mean_f_ib_b_mps2{Eigen::Vector3d::Zero()};
  double gyro_std_radps{0.0};  ///< norm of the three axes' standard deviations
  double force_std_mps2{0.0};
  int count{0};  ///< increments in it
};

/// Cuts IMU data into blocks of half a second. No heap, no exceptions.
class ImuBlocks {
 public:
  static constexpr double kBlockS = 0.5;

  /// @returns the block that this increment completes. @pre inc.dt_s > 0.
  std::optional<ImuBlock> push(const ImuIncrement& inc);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(dt_s_, count_, omega_sum_, omega_square_sum_, f_sum_, f_square_sum_);
  }

 private:
  double dt_s_{0.0};
  int count_{0};
  Eigen::Vector3d omega_sum_{Eigen::Vector3d::Zero()}, omega_square_sum_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d f_sum_{Eigen::Vector3d::Zero()}, f_square_sum_{Eigen::Vector3d::Zero()};
};

/// At rest when two blocks in a row look still. A single one may be the calm between two gears.
class StandstillDetector {
 public:
  /// @param imu  its white noise alone must not pass for motion
  /// @throws Error when a limit is not positive.
  StandstillDetector(const StandstillConfig& config, const ImuErrorModel& imu);

  /// @param filter  at the end of the block
  /// @returns whether the vehicle has stood still over this block and the one before.
  bool push(const ImuBlock& block, const Ekf& filter);

  /// Whether the horizontal acceleration over a block is no larger than its own error may be, which
  /// is that of tilt and accelerometer bias together: motion that tells nothing of the heading.
  bool is_even(const ImuBlock& block, const Ekf& filter) const;

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(was_still_);
  }

 private:
  bool looks_still(const ImuBlock& block, const Ekf& filter) const;

  StandstillConfig config_;
  double gyro_noise_rad_per_sqrt_s_;
  double force_noise_mps_per_sqrt_s_;
  bool was_still_{false};
};

}  // namespace leeway
