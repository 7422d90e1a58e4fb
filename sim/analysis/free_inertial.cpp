#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "sim/analysis/scene_covariance.hpp"

namespace leeway::sim {

void free_inertial(const Scene& scene, const ErrorTrack& track,
                   const std::function<bool(const CovariancePoint&)>& observer) {
  validate(scene);
  Scene perfectly_started = scene;
  perfectly_started.initial = InitialSigma{};
  perfectly_started.vehicle.reset();
  SceneCovariance<0> pair(perfectly_started, false, nullptr);
  CovariancePoint point;
  do {
    const Leg leg = track.leg(point.t_s, scene.duration_s);
    pair.propagate(leg);
    point.t_s = leg.end_s;
    point.r_e_m = truth_at(scene.trajectory, leg.end_s).nav.r_e_m;
    point.claimed = pair.claimed();
    point.truth = pair.truth();
  } while (observer(point) && point.t_s < scene.duration_s);
}

}  // namespace leeway::sim
