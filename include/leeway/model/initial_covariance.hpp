/// @file
/// The covariance that a filter starts from.
#pragma once

#include "leeway/earth/fields.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway {

/// 1 sigma of the initial error, isotropic per group except attitude.
struct InitialSigma {
  double tilt_rad{};
  double heading_rad{};
  double velocity_mps{};
  double position_m{};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"tilt_rad", c.tilt_rad, kNotNegative},
                   Field{"heading_rad", c.heading_rad, kNotNegative},
                   Field{"velocity_mps", c.velocity_mps, kNotNegative},
                   Field{"position_m", c.position_m, kNotNegative});
  }
};

/// Covariance of the 15 errors from sigmas: tilt and heading about the axes of north-east-down at
/// the estimate, bias sigmas from the model (turn-on and in-run together), zero where there is no
/// state.
ErrorMatrix initial_covariance(const Estimate& estimate, const InitialSigma& sigma,
                               const ImuErrorModel& imu, const BiasStates& biases = {});

}  // namespace leeway
