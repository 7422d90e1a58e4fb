#include "leeway/sim/analysis/coast.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "leeway/model/error_metric.hpp"

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

/// When the last fix before an outage is valid; the scene's start without one.
double last_fix_before(const Scene& scene, const Outage& outage) {
  double last_s = 0.0;
  for (const double t_s : fix_times_s(scene.gnss, scene.duration_s)) {
    if (t_s <= outage.start_s) last_s = t_s;
  }
  return last_s;
}

Coast coast_of(const Scene& scene, const ErrorTrack& track, const Outage& outage) {
  const AllowedError allowed = scene.limit.allowed();
  Coast coast{outage, end_of(scene, outage)};
  coast.limit_m = allowed.limit_m;
  coast.share = allowed.share;
  const double fix_s = last_fix_before(scene, outage);
  const auto allowed_at_m = [&](double t_s) {
    return allowed.after_m(distance_gone_m(scene, track, fix_s, t_s));
  };
  coast.end_allowed_m = allowed_at_m(coast.end_s);
  const auto error_at_m = [&](const CovariancePoint& point) {
    const Eigen::Matrix3d P_n_m2 = ned_covariance(point.r_e_m, point.truth.block<3, 3>(kDr, kDr));
    return error_by_metric_m(scene, track, point.t_s, P_n_m2);
  };
  std::optional<CovariancePoint> last;  // not beyond the start of the outage
  double before_s = outage.start_s;
  double before_m = 0.0;
  follow(with_endless(scene, outage), track, [&](const CovariancePoint& point) {
    if (point.t_s <= outage.start_s) {
      last = point;
      return;
    }
    if (last) {
      before_s = last->t_s;
      before_m = error_at_m(*last);
      last.reset();
    }
    const double error_m = error_at_m(point);
    const auto part_of = [&](double t_s) { return (t_s - before_s) / (point.t_s - before_s); };
    if (before_s < coast.end_s && point.t_s >= coast.end_s) {
      coast.end_error_m = std::lerp(before_m, error_m, part_of(coast.end_s));
    }
    const double beyond_m = error_m - allowed_at_m(point.t_s);
    if (std::isnan(coast.coast_s) && beyond_m > 0.0) {
      const double left_m = std::max(allowed_at_m(before_s) - before_m, 0.0);
      const double part = left_m / (left_m + beyond_m);
      coast.coast_s = std::lerp(before_s, point.t_s, part) - outage.start_s;
    }
    before_s = point.t_s;
    before_m = error_m;
  });
  if (coast.end_error_m == 0.0) coast.end_error_m = before_m;
  return coast;
}

}  // namespace

std::vector<Coast> coasts(const Scene& of_scene, const ErrorTrack& track,
                          const AllowedError& allowed) {
  Scene scene = of_scene;
  scene.limit.allow(allowed);
  std::vector<Coast> answers;
  for (const Outage& outage : scene.gnss.outages) {
    answers.push_back(coast_of(scene, track, outage));
  }
  return answers;
}

}  // namespace leeway::sim
