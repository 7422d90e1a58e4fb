/// @file
/// GNSS fixes on a trajectory. Their position error is partly correlated over tens of seconds,
/// which the stated covariance cannot express.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/fields.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sim/motion/trajectory.hpp"
#include "leeway/sim/tools/random.hpp"

namespace leeway::sim {

/// Errors of a GNSS receiver, independent of each other, in north-east-down axes at the antenna.
struct GnssErrorModel {
  Eigen::Vector3d position_sigma_n_m{2.5, 2.5, 3.5};       ///< white, >= 0
  Eigen::Vector3d velocity_sigma_n_mps{0.05, 0.05, 0.05};  ///< white, > 0
  Eigen::Vector3d correlated_sigma_n_m{0.0, 0.0, 0.0};     ///< Gauss-Markov, in position, >= 0
  double correlation_time_s{60.0};                         ///< of the Gauss-Markov process, > 0
  Eigen::Vector3d lever_arm_b_m{0.0, 0.0, 0.0};            ///< IMU to antenna

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"position_sigma_n_m", c.position_sigma_n_m, kNotNegative},
                   Field{"velocity_sigma_n_mps", c.velocity_sigma_n_mps, kPositive},
                   Field{"correlated_sigma_n_m", c.correlated_sigma_n_m, kNotNegative},
                   Field{"correlation_time_s", c.correlation_time_s, kPositiveOrInfinite},
                   Field{"lever_arm_b_m", c.lever_arm_b_m});
  }
};

/// Validation of the model. On each axis the white or the correlated position sigma must be > 0, or
/// the stated covariance would be singular.
/// @throws Error naming the field, its value and the allowed range.
void validate(const GnssErrorModel& model);

/// A receiver on a trajectory that gives fixes at any ascending times.
class GnssSimulator {
 public:
  /// A receiver with its random numbers. The model is validated.
  /// @throws Error when the model is not valid or the trajectory has no motion.
  GnssSimulator(const Trajectory& trajectory, const GnssErrorModel& model, const Random& random);

  /// The fix at t_s: position and velocity of the antenna with their errors. The stated covariances
  /// are those of the errors: for the position the white plus the correlated variance.
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
