/// @file
/// Filters side by side: every one on the same noise, trial by trial, and what they cost.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "leeway/model/error_metric.hpp"
#include "leeway/sim/compare/compare.hpp"
#include "leeway/sim/trials/trial.hpp"

namespace leeway::sim {

/// One filter on the sensors of a plan.
struct FilterCase {
  const TrialPlan* plan{};
  Variant variant{};
  EkfConfig config{};        ///< all that the variant does not say; biases that are no states are
                             ///< certain
  bool knows_latency{true};  ///< else fixes are taken for valid when they arrive
};

/// One case in one trial.
struct CaseRun {
  TrialScore score{};
  std::vector<Eigen::Vector3d> error_n_m{};  ///< before scored fixes; worth nothing if not finite
  std::vector<double> course_rad{};          ///< of the truth then, over ground
};

/// All cases in all trials of the first one's plan: runs[case][trial]. The same bits on any number
/// of threads.
std::vector<std::vector<CaseRun>> run_cases(const std::vector<FilterCase>& cases, int threads,
                                            const std::function<void(double)>& progress);

/// Processor times of the cases in the first trial of their plan, all of one, in ns per second of
/// IMU data: times[case][round]. Each round runs all in turn: what slows the machine for a while
/// slows all alike.
std::vector<std::vector<double>> times_ns_per_s(const std::vector<FilterCase>& cases, int rounds,
                                                const std::function<void(double)>& progress = {});

/// Median, least and most. @pre not empty
Cost cost_of(std::vector<double> ns_per_s);

/// Sizes by the metric of the errors of the trials that are finite.
std::vector<double> sizes_m(ErrorMetric metric, const std::vector<CaseRun>& runs);

/// NIS and counts of fixes left out.
CampaignResult figures_of(const std::vector<CaseRun>& runs);

}  // namespace leeway::sim
