/// @file
/// The error tracks of a scene with one IMU after the other. A track knows of the IMU only how fast
/// its biases and the filter's states of them change: a few serve a whole catalogue.
#pragma once

#include <array>
#include <map>

#include "leeway/model/process_noise.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "sim/analysis/truth_model.hpp"

namespace leeway::sim {

class CandidateTracks {
 public:
  explicit CandidateTracks(double step_s) : step_s_(step_s) {}

  /// The track of a scene; those of one motion and duration share them. Stays where it is.
  const ErrorTrack& of(const Scene& scene) {
    const auto key = key_of(scene);
    auto found = tracks_.find(key);
    if (found == tracks_.end()) found = tracks_.emplace(key, error_track(scene, step_s_)).first;
    return found->second;
  }

 private:
  using Key = std::array<double, 5>;

  static Key key_of(const Scene& scene) {
    const ProcessNoise noise = process_noise(scene.filter.imu, scene.filter.biases);
    const auto drift_s = [](const TriadErrorModel& triad) {
      return triad.in_run.sigma > 0.0 ? triad.in_run.tau_s : 0.0;
    };
    const bool has_parameters = !parameter_moments(scene.imu).empty();
    return {noise.tau_a_s, noise.tau_g_s, drift_s(scene.imu.accelerometer), drift_s(scene.imu.gyro),
            has_parameters ? 1.0 : 0.0};
  }

  double step_s_;
  std::map<Key, ErrorTrack> tracks_{};
};

}  // namespace leeway::sim
