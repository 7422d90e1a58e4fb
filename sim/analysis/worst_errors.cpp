#include "leeway/sim/analysis/worst_errors.hpp"

#include <algorithm>

#include "leeway/model/error_metric.hpp"

namespace leeway::sim {
namespace {

/// The first that has gone farther.
auto longer_than(const std::vector<ErrorBeforeFix>& errors, double distance_m) {
  return std::upper_bound(
      errors.begin(), errors.end(), distance_m,
      [](double gone_m, const ErrorBeforeFix& e) { return gone_m < e.distance_m; });
}

}  // namespace

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
  return {error_by_metric_m(scene, track, t_s, P_n_m2), distance_gone_m(scene, track, fix_s, t_s)};
}

double WorstErrors::largest_m(double distance_m) const {
  const auto longer = longer_than(errors_, distance_m);
  return longer == errors_.begin() ? 0.0 : (longer - 1)->error_m;
}

void WorstErrors::add(const ErrorBeforeFix& error) {
  if (!errors_.empty() && error.error_m <= largest_m(error.distance_m)) return;
  const auto longer = longer_than(errors_, error.distance_m);
  const auto first = std::lower_bound(
      errors_.cbegin(), longer, error.distance_m,
      [](const ErrorBeforeFix& e, double distance_m) { return e.distance_m < distance_m; });
  const auto larger = std::find_if(longer, errors_.cend(), [&error](const ErrorBeforeFix& e) {
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
