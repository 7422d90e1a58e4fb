/// @file
/// Filters side by side: every one on the same noise, trial by trial.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <tuple>
#include <utility>
#include <vector>

#include "leeway/sim/compare/variant.hpp"
#include "leeway/sim/trials/campaign.hpp"
#include "sim/compare/variant_run.hpp"
#include "sim/trials/recorded_trial.hpp"

namespace leeway::sim {

/// One filter on the sensors of a plan.
struct FilterCase {
  const TrialPlan* plan{};
  Variant variant{};
  EkfConfig config{};        ///< all that the variant does not say
  bool knows_latency{true};  ///< else fixes are taken for valid when they arrive
};

/// The trials of one seed as cases are given them, each made when it is first asked for.
class GivenTrials {
 public:
  explicit GivenTrials(std::uint64_t seed) : seed_(seed) {}

  /// Lives as long as this.
  const RecordedTrial& to(const FilterCase& one);

 private:
  using Key = std::tuple<const TrialPlan*, int, bool>;

  RecordedTrial made(const FilterCase& one);

  std::uint64_t seed_;
  std::vector<std::pair<Key, std::unique_ptr<RecordedTrial>>> trials_{};
};

/// As run_variant(); biases that are no states are certain.
double run_case(const FilterCase& one, const RecordedTrial& trial,
                const ScoreObserver& observer = {});

/// One case in one trial.
struct CaseRun {
  TrialScore score{};
  std::vector<Eigen::Vector2d> error_ne_m{};  ///< before scored fixes; worth nothing if not finite
};

/// All cases in all trials of the first one's plan: runs[case][trial]. The same bits on any number
/// of threads.
std::vector<std::vector<CaseRun>> run_cases(const std::vector<FilterCase>& cases, int threads,
                                            const std::function<void(double)>& progress);

/// Horizontal errors of the trials that are finite.
std::vector<double> radial_errors_m(const std::vector<CaseRun>& runs);

/// NIS and counts of fixes left out.
CampaignResult figures_of(const std::vector<CaseRun>& runs);

}  // namespace leeway::sim
