/// @file
/// The error tracks of a scene with one IMU after the other.
#pragma once

#include <functional>
#include <map>
#include <memory>

#include "leeway/sim/analysis/error_track.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// Whether the vehicle rests at a time in s, by the word of a detector. Empty: it rests where the
/// trajectory does.
using RestsAt = std::function<bool(double t_s)>;

/// Error tracks of scenes on the same trajectory and of the same duration: the motion is sampled
/// once for all of them. Not for use by several threads.
class SceneTracks {
 public:
  /// error_track() of a scene.
  ErrorTrack of(const Scene& scene, double step_s = 1.0, const RestsAt& rests_at = {});

 private:
  std::map<double, std::shared_ptr<const MotionSamples>> motions_{};  // by the longest step
};

}  // namespace leeway::sim
