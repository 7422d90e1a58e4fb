/// @file
/// The vehicle of a scene: what the estimator is told of it, and what it carries beside IMU and
/// receiver.
#pragma once

#include <optional>

#include "leeway/navigator/aidings.hpp"
#include "leeway/navigator/navigator_config.hpp"

namespace leeway::sim {

/// A sensor of the vehicle: when it reads, and its white noise in the unit of its reading. What
/// else is wrong with it is what the estimator takes for possible: the scale of the odometer and
/// the offset of the barometer are drawn from VehicleConfig's sigmas and walk as it says.
struct VehicleSensor {
  double interval_s{};
  double sigma{};  ///< m/s, m or rad

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"interval_s", c.interval_s, between(1e-3, 1e6)},
                   Field{"sigma", c.sigma, kPositive});
  }
};

/// Sensors as a scene has them that says no more than that they are there.
inline constexpr VehicleSensor kUsualOdometer{0.1, OdometerSpeed{}.sigma_mps};
inline constexpr VehicleSensor kUsualBarometer{1.0, BarometricHeight{}.sigma_m};
inline constexpr VehicleSensor kUsualHeading{1.0, MeasuredHeading{}.sigma_rad};

/// A vehicle. Its motion is the trajectory's, without side slip: the point that never slides is the
/// IMU's own, which is why rear_axle_x_m is 0 here unless a scene says otherwise.
struct SceneVehicle {
  VehicleConfig config{};
  std::optional<VehicleSensor> odometer{};
  std::optional<VehicleSensor> barometer{};
  std::optional<VehicleSensor> heading{};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"config", c.config}, Field{"odometer", c.odometer},
                   Field{"barometer", c.barometer}, Field{"heading", c.heading});
  }
};

/// A vehicle of a kind with what its motion alone tells, and no sensor.
SceneVehicle scene_vehicle(VehicleKind kind);

}  // namespace leeway::sim
