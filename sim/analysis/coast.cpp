#include "leeway/sim/analysis/coast.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/model/horizontal.hpp"

namespace leeway::sim {
namespace {

/// The scene with the outages until this one, which never ends.
Scene with_endless(const Scene& scene, const Outage& outage) {
  Scene endless = scene;
  endless.gnss.outages.clear();
  for (const Outage& other : scene.gnss.outages) {
    if (other.start_s < outage.start_s) endless.gnss.outages.push_back(other);
  }
  endless.gnss.outages.push_back({outage.start_s, scene.duration_s});
  return endless;
}

/// When the first fix after an outage arrives.
double end_of(const Scene& scene, const Outage& outage) {
  for (const double t_s : fix_times_s(scene.gnss, scene.duration_s)) {
    const double arrival_s = t_s + scene.gnss.latency_s;
    if (t_s > outage.start_s + outage.duration_s) return std::min(arrival_s, scene.duration_s);
  }
  return scene.duration_s;
}

Coast coast_of(const Scene& scene, const ErrorTrack& track, const Outage& outage, double limit_m) {
  Coast coast{outage, end_of(scene, outage)};
  coast.limit_m = limit_m;
  double before_s = outage.start_s;
  double before_m = 0.0;
  follow(with_endless(scene, outage), track, [&](const CovariancePoint& point) {
    const double error_m =
        horizontal_error_m(scene.limit.metric,
                           horizontal_covariance(point.r_e_m, point.truth.block<3, 3>(kDr, kDr)));
    if (point.t_s > outage.start_s) {
      const auto share_of = [&](double t_s) { return (t_s - before_s) / (point.t_s - before_s); };
      if (before_s < coast.end_s && point.t_s >= coast.end_s) {
        coast.end_error_m = std::lerp(before_m, error_m, share_of(coast.end_s));
      }
      if (std::isnan(coast.coast_s) && error_m > limit_m) {
        const double share = before_m > limit_m ? 0.0 : (limit_m - before_m) / (error_m - before_m);
        coast.coast_s = std::lerp(before_s, point.t_s, share) - outage.start_s;
      }
    }
    before_s = point.t_s;
    before_m = error_m;
  });
  if (coast.end_error_m == 0.0) coast.end_error_m = before_m;
  return coast;
}

}  // namespace

std::vector<Coast> coasts(const Scene& scene, const ErrorTrack& track, double limit_m) {
  std::vector<Coast> answers;
  for (const Outage& outage : scene.gnss.outages) {
    answers.push_back(coast_of(scene, track, outage, limit_m));
  }
  return answers;
}

}  // namespace leeway::sim
