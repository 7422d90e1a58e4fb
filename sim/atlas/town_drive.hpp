/// @file
/// A car in turns, with a fix every second: what the scenes of times, units and sensors spoil.
#pragma once

#include <functional>
#include <vector>

#include "leeway/sim/scene/scene.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim {

/// The square loop at 20 m/s on a car-grade MEMS IMU at 100 Hz, white fixes of 2.5 m.
Scene town_drive(double duration_s);

/// What a driver, a clock or a sensor does to the inputs of a trial. They are delivered where the
/// trial has them, whatever times they then bear.
using Spoil = std::function<void(RecordedTrial& trial)>;

/// A condition of a scene.
struct Fault {
  std::string condition{};
  Spoil spoil{};
};

Spoil each_increment(std::function<void(ImuIncrement&)> spoil);
Spoil each_fix(std::function<void(GnssFix&)> spoil);

std::vector<RecordedTrial> spoiled(std::vector<RecordedTrial> trials, const Spoil& spoil);

}  // namespace leeway::sim
