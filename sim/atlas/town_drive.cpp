#include "sim/atlas/town_drive.hpp"

#include "leeway/sim/motion/trajectories.hpp"

namespace leeway::sim {

Scene town_drive(double duration_s) {
  return car_grade_scene(
      "town drive", square_loop({.straight_s = 10.0, .duration_s = duration_s}), duration_s, 100.0,
      {.tilt_rad = 0.01, .heading_rad = 0.05, .velocity_mps = 0.1, .position_m = 3.0});
}

std::vector<RecordedTrial> spoiled(std::vector<RecordedTrial> trials, const Spoil& spoil) {
  for (RecordedTrial& trial : trials) spoil(trial);
  return trials;
}

Score late_horizontal_rms_m(const Scene& scene, double last_s) {
  return [from_s = scene.duration_s - last_s](WatchedFilter& filter, const RecordedTrial& trial) {
    return errors_after(filter, trial, from_s).horizontal_rms_m();
  };
}

}  // namespace leeway::sim
