#include "sim/analysis/scored_fixes.hpp"

#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/model/error_metric.hpp"
#include "leeway/model/horizontal.hpp"

namespace leeway::sim {

bool ScoredFixes::add(const CovariancePoint& before, double last_fix_s) {
  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(before.r_e_m));
  const auto along_ned = [&C_en](const ErrorMatrix& P) -> Eigen::Matrix3d {
    return C_en.transpose() * P.block<3, 3>(kDr, kDr) * C_en;
  };
  const Eigen::Matrix3d claimed_n_m2 = along_ned(before.claimed);
  const Eigen::Matrix3d true_n_m2 = along_ned(before.truth);
  claimed_sum_n_m2_ += claimed_n_m2.diagonal();
  true_sum_n_m2_ += true_n_m2.diagonal();
  ++fixes_;
  const double distance_m = distance_gone_m(scene_, track_, last_fix_s, before.t_s);
  CovarianceAnalysis& r = result_;
  if (may_be_worst(r.claimed_errors, claimed_n_m2, distance_m)) {
    r.claimed_errors.add(size_of(before, claimed_n_m2, distance_m));
  }
  if (!may_be_worst(r.true_errors, true_n_m2, distance_m)) return false;
  const ErrorBeforeFix truth = size_of(before, true_n_m2, distance_m);
  r.true_errors.add(truth);
  const AllowedError allowed = scene_.limit.allowed();
  if (truth.over(allowed) <= worst_) return false;
  worst_ = truth.over(allowed);
  r.true_m = truth.error_m;
  r.allowed_m = allowed.after_m(truth.distance_m);
  r.worst_s = before.t_s;
  r.worst = before;
  return true;
}

CovarianceAnalysis ScoredFixes::result() const {
  CovarianceAnalysis r = result_;
  r.claimed_m = r.claimed_errors.worst(scene_.limit.allowed()).error_m;
  r.claimed_drms_m = std::sqrt(claimed_sum_n_m2_.head<2>().sum() / fixes_);
  r.true_rms_n_m = (true_sum_n_m2_ / fixes_).cwiseSqrt();
  r.true_drms_m = r.true_rms_n_m.head<2>().norm();
  return r;
}

ErrorBeforeFix ScoredFixes::size_of(const CovariancePoint& point, const Eigen::Matrix3d& P_n_m2,
                                    double distance_m) const {
  return {error_by_metric_m(scene_, track_, point.t_s, P_n_m2), distance_m};
}

/// Whether the error is larger than all after no longer a way: a radius takes ten times as long.
bool ScoredFixes::may_be_worst(const WorstErrors& known, const Eigen::Matrix3d& P_n_m2,
                               double distance_m) const {
  const double probability = radius_probability(scene_.limit.metric);
  const double known_m = known.largest_m(distance_m);
  if (probability == 0.0 || known_m == 0.0) return true;
  const Eigen::Matrix2d P_ne_m2 = P_n_m2.topLeftCorner<2, 2>();
  const double circle_m2 = -2.0 * std::log1p(-probability) * principal_variances(P_ne_m2).x();
  if (circle_m2 <= known_m * known_m) return false;
  return !(probability_beyond(P_ne_m2, known_m) < 1.0 - probability);
}

}  // namespace leeway::sim
