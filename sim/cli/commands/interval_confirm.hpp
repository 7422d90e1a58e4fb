/// @file
/// The nonlinear check of solved intervals: does the filter, run for real, err as the linear
/// analysis says?
#pragma once

#include <optional>
#include <vector>

#include "leeway/sim/analysis/interval.hpp"
#include "leeway/sim/trials/campaign.hpp"

namespace leeway::cli {

/// What the Monte Carlo found at a solved interval.
struct Confirmation {
  sim::CampaignResult campaign{};
  double rms_over_true{};  ///< to the linear analysis, which knows the unmodelled errors
  /// The filter errs as much as it claims and as the linear analysis says: NEES and the squared RMS
  /// within the band that an honest filter leaves once in a thousand times, and no trial diverged.
  bool consistent{false};
  /// Where it is not: the interval at which the Monte Carlo's error meets the limit.
  std::optional<double> interval_s{};
};

struct SolvedImu {
  sim::Scene scene{};
  std::vector<sim::Interval> intervals{};
  std::vector<std::optional<Confirmation>> confirmations{};  ///< as intervals; empty: not asked for
};

/// Fills in the confirmations, showing progress.
/// @param limits_m  of which answers; empty: of all
void confirm(std::vector<SolvedImu>& solved, int trials, const std::vector<double>& limits_m);

}  // namespace leeway::cli
