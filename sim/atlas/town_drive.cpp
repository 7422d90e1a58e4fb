#include "sim/atlas/town_drive.hpp"

#include "leeway/model/initial_covariance.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"

namespace leeway::sim {

Scene town_drive(double duration_s) {
  Scene scene;
  scene.name = "town drive";
  scene.trajectory = square_loop({.straight_s = 10.0, .duration_s = duration_s});
  scene.duration_s = duration_s;
  scene.imu_rate_hz = 100.0;
  set_imu(scene, "automotive-mems", automotive_mems_model());
  scene.filter.gnss_correlation_s = 0.0;
  scene.initial =
      InitialSigma{.tilt_rad = 0.01, .heading_rad = 0.05, .velocity_mps = 0.1, .position_m = 3.0};
  return scene;
}

std::vector<RecordedTrial> spoiled(std::vector<RecordedTrial> trials, const Spoil& spoil) {
  for (RecordedTrial& trial : trials) spoil(trial);
  return trials;
}

Score late_horizontal_rms_m(const Scene& scene, double last_s) {
  const Time from = time_from_seconds(scene.duration_s - last_s);
  return [from](WatchedFilter& filter, const RecordedTrial& trial) {
    ErrorSums sums;
    replay(filter, trial, [&](const Estimate& truth, const WatchedFilter& now) {
      if (truth.nav.time > from) sums.add(truth, now);
    });
    return sums.horizontal_rms_m();
  };
}

}  // namespace leeway::sim
