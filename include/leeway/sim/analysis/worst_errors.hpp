/// @file
/// The errors before fixes that can be the worst by some limit.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "leeway/sim/analysis/error_track.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// An error just before a fix, and the length of the way since the fix before it.
struct ErrorBeforeFix {
  double error_m{};
  double distance_m{};

  /// Above 1 where the error is beyond what is allowed.
  double over(const AllowedError& allowed) const { return error_m / allowed.after_m(distance_m); }
};

/// Size of a position error by the scene's metric, along and across the track by the course of
/// GroundPath. @param P_n_m2  along north, east, down
double error_by_metric_m(const Scene& scene, const ErrorTrack& track, double t_s,
                         const Eigen::Matrix3d& P_n_m2);

/// Length in m of the way between two times, where the scene's limit grows with it; else 0.
double distance_gone_m(const Scene& scene, const ErrorTrack& track, double from_s, double to_s);

/// Both, of an error at a time since a fix at another.
ErrorBeforeFix error_before_fix(const Scene& scene, const ErrorTrack& track, double fix_s,
                                double t_s, const Eigen::Matrix3d& P_n_m2);

/// Errors before fixes, but for those that are no larger than another one after no longer a way: by
/// no limit, growing or not, are they the worst. So one analysis answers for every limit.
class WorstErrors {
 public:
  void add(const ErrorBeforeFix& error);

  /// The largest error in m after no longer a way than this; 0 where there is none.
  double largest_m(double distance_m) const;

  /// The error that is largest over what is allowed. @pre one has been added, allowed.limit_m > 0.
  ErrorBeforeFix worst(const AllowedError& allowed) const;

 private:
  std::vector<ErrorBeforeFix> errors_{};  // error and way ascending
};

}  // namespace leeway::sim
