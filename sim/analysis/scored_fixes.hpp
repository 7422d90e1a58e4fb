/// @file
/// What the errors before the fixes that count add up to, and the worst of them. Part of
/// covariance_analysis.
#pragma once

#include "leeway/sim/analysis/covariance_analysis.hpp"

namespace leeway::sim {

/// The errors before fixes, claimed and true. That of a fix by the scene's metric is worked out
/// only where it may be the worst by some limit.
class ScoredFixes {
 public:
  ScoredFixes(const Scene& scene, const ErrorTrack& track) : scene_(scene), track_(track) {}

  /// @param last_fix_s  of the fix before this one
  /// @returns whether the true error is the worst so far
  bool add(const CovariancePoint& before, double last_fix_s);

  bool empty() const { return fixes_ == 0; }

  /// Errors of the result; the rest of it is left as it is.
  CovarianceAnalysis result() const;

 private:
  ErrorBeforeFix size_of(const CovariancePoint& point, const Eigen::Matrix3d& P_n_m2,
                         double distance_m) const;
  bool may_be_worst(const WorstErrors& known, const Eigen::Matrix3d& P_n_m2,
                    double distance_m) const;

  const Scene& scene_;
  const ErrorTrack& track_;
  int fixes_{0};
  Eigen::Vector3d claimed_sum_n_m2_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d true_sum_n_m2_{Eigen::Vector3d::Zero()};
  double worst_{0.0};  // over what is allowed
  CovarianceAnalysis result_{};
};

}  // namespace leeway::sim
