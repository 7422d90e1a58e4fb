/// @file
/// Everything the error-state filter can be told about its IMU, its receiver and itself.
#pragma once

#include <Eigen/Core>

#include "leeway/earth/fields.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway {

/// The defaults suit a car.
struct EkfConfig {
  ImuErrorModel imu{automotive_mems_model()};
  BiasStates biases{};
  StrapdownPolicy strapdown{};
  Eigen::Vector3d lever_arm_b_m{Eigen::Vector3d::Zero()};  ///< IMU to GNSS antenna, body axes
  /// Correlation time of the GNSS position error. Fixes closer together than this repeat much of
  /// the same error: each is fused with R (1 + a) / (1 - a), a = exp(-dt / time), the white noise
  /// whose mean wanders as much. 0: the error is white.
  double gnss_correlation_s{30.0};
  /// A fix is refused when a right one would look as bad with less than this probability. 0: no
  /// gate.
  double gate_probability{1e-6};
  /// P is propagated when this much time has accumulated in Phi, and before every update; the
  /// gravity gradient is that of the place where Phi begins. 0: at every increment.
  double covariance_interval_s{0.1};
  /// Whether the error of the position changes gravity in Phi.
  bool gravity_gradient{true};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"imu", c.imu}, Field{"biases", c.biases}, Field{"strapdown", c.strapdown},
                   Field{"lever_arm_b_m", c.lever_arm_b_m, between(-1e3, 1e3)},
                   Field{"gnss_correlation_s", c.gnss_correlation_s, between(0.0, 1e6)},
                   Field{"gate_probability", c.gate_probability, zero_or(1e-100, 1.0 - 1e-16)},
                   Field{"covariance_interval_s", c.covariance_interval_s, between(0.0, 10.0)},
                   Field{"gravity_gradient", c.gravity_gradient});
  }
};

/// @throws Error when a value is out of range: the field, its value, the allowed range.
void validate(const EkfConfig& config);

/// Whether filters of any kind can begin with this.
/// @throws Error as above, and when the estimate is not finite, not on the Earth or not a rotation.
void validate(const EkfConfig& config, const Estimate& estimate);

}  // namespace leeway
