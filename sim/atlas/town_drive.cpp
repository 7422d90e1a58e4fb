#include "sim/atlas/town_drive.hpp"

#include <utility>

#include "leeway/sim/motion/trajectories.hpp"

namespace leeway::sim {

Scene town_drive(double duration_s) {
  return drive_scene(
      square_loop({.straight_s = 10.0, .duration_s = duration_s}), 100.0,
      {.tilt_rad = 0.01, .heading_rad = 0.05, .velocity_mps = 0.1, .position_m = 3.0});
}

Spoil each_increment(std::function<void(ImuIncrement&)> spoil) {
  return [spoil = std::move(spoil)](RecordedTrial& trial) {
    for (ImuIncrement& inc : trial.imu) spoil(inc);
  };
}

Spoil each_fix(std::function<void(GnssFix&)> spoil) {
  return [spoil = std::move(spoil)](RecordedTrial& trial) {
    for (RecordedTrial::Fix& fix : trial.fixes) spoil(fix.fix);
  };
}

std::vector<RecordedTrial> spoiled(std::vector<RecordedTrial> trials, const Spoil& spoil) {
  for (RecordedTrial& trial : trials) spoil(trial);
  return trials;
}

}  // namespace leeway::sim
