#include "leeway/sim/analysis/worst_errors.hpp"

#include <algorithm>

#include "leeway/model/error_metric.hpp"

namespace leeway::sim {

double error_by_metric_m(const Scene& scene, const ErrorTrack& track, double t_s,
                         const Eigen::Matrix3d& P_n_m2) {
  const ErrorMetric metric = scene.limit.metric;
  if (!asks_for_course(metric)) return error_size_m(metric, P_n_m2, 0.0);
  return error_size_m(metric, P_n_m2, track.path().course_rad(t_s));
}

double distance_gone_m(const Scene& scene, const ErrorTrack& track, double from_s, double to_s) {
  return scene.limit.share > 0.0 ? track.path().distance_m(from_s, to_s) : 0.0;
}

ErrorBeforeFix error_before_fix(const Scene& scene, const ErrorTrack& track, double fix_s,
                                double t_s, const Eigen::Matrix3d& P_n_m2) {
  return {error_by_metric_m(scene, track, t_s, P_n_m2),
          distance_gone_m(scene, track, fix_s, t_s)};
}

void WorstErrors::add(const ErrorBeforeFix& error) {
  const auto longer = std::upper_bound(
      errors_.begin(), errors_.end(), error.distance_m,
      [](double distance_m, const ErrorBeforeFix& e) { return distance_m < e.distance_m; });
  // The one before has gone no farther.
  if (longer != errors_.begin() && (longer - 1)->error_m >= error.error_m) return;
  const auto first = std::lower_bound(
      errors_.begin(), longer, error.distance_m,
      [](const ErrorBeforeFix& e, double distance_m) { return e.distance_m < distance_m; });
  const auto larger = std::find_if(longer, errors_.end(), [&error](const ErrorBeforeFix& e) {
    return e.error_m > error.error_m;
  });
  errors_.insert(errors_.erase(first, larger), error);
}

ErrorBeforeFix WorstErrors::worst(const AllowedError& allowed) const {
  return *std::max_element(errors_.begin(), errors_.end(),
                           [&allowed](const ErrorBeforeFix& a, const ErrorBeforeFix& b) {
                             return a.over(allowed) < b.over(allowed);
                           });
}

}  // namespace leeway::sim
