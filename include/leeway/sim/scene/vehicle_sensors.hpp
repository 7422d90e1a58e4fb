/// @file
/// The sensors of a scene's vehicle beside IMU and receiver, simulated: odometer, barometer,
/// measured heading.
#pragma once

#include <functional>

#include "leeway/navigator/aidings.hpp"
#include "leeway/sim/motion/trajectory.hpp"
#include "leeway/sim/scene/scene_vehicle.hpp"
#include "leeway/sim/tools/random.hpp"

namespace leeway::sim {

/// Sensors that read the truth at whole multiples of their interval, each with white noise. The
/// odometer has a scale, the barometer an offset: drawn once, then walking at random.
class VehicleSensors {
 public:
  VehicleSensors(const SceneVehicle& vehicle, std::uint64_t seed);

  /// Calls f with every reading that is due in (from_s, to_s], at the time to_s.
  void read(const Trajectory& trajectory, Time now, double from_s, double to_s,
            const std::function<void(const Reading&)>& f);

  bool any() const { return vehicle_.odometer || vehicle_.barometer || vehicle_.heading; }

 private:
  /// A parameter of a sensor that walks at random.
  struct Walk {
    double value{};
    double per_sqrt_s{};
    double at_s{0.0};

    double moved_to(double t_s, Random& random);
  };

  Reading odometer_reading(Time now, const TruthPoint& truth);
  Reading barometer_reading(Time now, const TruthPoint& truth);
  Reading heading_reading(Time now, const TruthPoint& truth);

  SceneVehicle vehicle_;
  Random random_;
  Walk scale_{};
  Walk offset_m_{};
};

}  // namespace leeway::sim
