#include <algorithm>
#include <limits>
#include <memory>

#include "leeway/model/process_noise.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/analysis/scene_tracks.hpp"
#include "sim/analysis/aiding_rows.hpp"
#include "sim/analysis/motion_samples.hpp"
#include "sim/analysis/truth_model.hpp"

namespace leeway::sim {
namespace {

/// A step must resolve the sensors' in-run drift.
double step_limit_s(const ImuErrorModel& imu) {
  double shortest_s = std::numeric_limits<double>::infinity();
  for (const TriadErrorModel* triad : {&imu.accelerometer, &imu.gyro}) {
    if (triad->in_run.sigma > 0.0) shortest_s = std::min(shortest_s, triad->in_run.tau_s);
  }
  return std::max(0.1 * shortest_s, 0.01);
}

}  // namespace

ErrorTrack SceneTracks::of(const Scene& scene, double step_s, const RestsAt& rests_at) {
  const ProcessNoise noise = process_noise(scene.filter.imu, scene.filter.biases);
  const ErrorTrackConfig config{std::min(step_s, step_limit_s(scene.imu)),
                                !parameter_moments(scene.imu).empty(), noise.tau_a_s,
                                noise.tau_g_s};
  std::shared_ptr<const MotionSamples>& motion = motions_[config.step_s];
  if (!motion) {
    motion = std::make_shared<MotionSamples>(scene.trajectory, scene.duration_s, config.step_s);
  }
  ErrorTrack track(motion, config);
  if (scene.vehicle || scene.estimator == SceneEstimator::kNavigator) {
    track.set_aiding(std::make_shared<SceneAiding>(scene, motion, rests_at));
  }
  return track;
}

ErrorTrack error_track(const Scene& scene, double step_s) {
  return SceneTracks().of(scene, step_s);
}

}  // namespace leeway::sim
