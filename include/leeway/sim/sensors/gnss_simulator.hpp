/// @file
/// What a GNSS receiver reports on a trajectory. Its position error is partly correlated over tens
/// of seconds, which a white covariance cannot show.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/fields.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sim/motion/trajectory.hpp"
#include "leeway/sim/tools/random.hpp"

namespace leeway::sim {

/// Errors are in north-east-down axes at the antenna, independent of each other.
struct GnssErrorModel {
  Eigen::Vector3d position_sigma_n_m{2.5, 2.5, 3.5};       ///< white, >= 0
  Eigen::Vector3d velocity_sigma_n_mps{0.05, 0.05, 0.05};  ///< white, > 0
  Eigen::Vector3d correlated_sigma_n_m{0.0, 0.0, 0.0};     ///< Gauss-Markov, of position, >= 0
  double correlation_time_s{60.0};                         ///< of that process, > 0
  Eigen::Vector3d lever_arm_b_m{0.0, 0.0, 0.0};            ///< IMU to antenna

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"position_sigma_n_m", c.position_sigma_n_m, kNotNegative},
                   Field{"velocity_sigma_n_mps", c.velocity_sigma_n_mps, kPositive},
                   Field{"correlated_sigma_n_m", c.correlated_sigma_n_m, kNotNegative},
                   Field{"correlation_time_s", c.correlation_time_s, kPositiveOrInfinite},
                   Field{"lever_arm_b_m", c.lever_arm_b_m});
  }
};

/// @throws Error naming the field, its value and the allowed range. Of the white and the correlated
/// position sigma of an axis at least one must be > 0, or the reported covariance is singular.
void validate(const GnssErrorModel& model);

/// Fixes at any times that ascend.
class GnssSimulator {
 public:
  /// @throws Error when the model is not valid or the trajectory has no motion.
  GnssSimulator(const Trajectory& trajectory, const GnssErrorModel& model, const Random& random);

  /// Antenna position and velocity with their errors. The covariances reported are those of the
  /// errors made: for position the white plus the correlated variance.
  /// @throws Error unless t_s is finite and later than that of the fix before.
  GnssFix fix_at(double t_s);

 private:
  void advance_correlated_error(double t_s);

  Trajectory trajectory_;
  GnssErrorModel model_;
  Random random_;
  Eigen::Vector3d correlated_error_n_m_;
  std::optional<double> last_s_{};
};

}  // namespace leeway::sim
