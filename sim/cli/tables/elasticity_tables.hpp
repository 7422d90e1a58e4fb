/// @file
/// What stands beside an answer of `leeway interval`: how it changes with each specification, its
/// spread over the IMU's own data, and what the closed forms make of it.
#pragma once

#include "leeway/sim/analysis/elasticity.hpp"
#include "leeway/sim/analysis/interval_spread.hpp"
#include "leeway/sim/analysis/roofline.hpp"
#include "sim/cli/answer.hpp"

namespace leeway::cli {

/// What stands beside one answer.
struct Sensitivity {
  sim::Elasticities elasticities{};
  std::optional<sim::IntervalSpread> spread{};
  double roofline_s{};      ///< the interval by the least crossing
  double roofline_sum_s{};  ///< by the root of the sum of squares
};

/// @pre the answer has an interval.
/// @throws Error when the scene is invalid.
Sensitivity sensitivity_of(const sim::Scene& scene, const sim::Interval& answer);

void print_elasticities(const sim::Elasticities& elasticities);
Json elasticities_json(const sim::Elasticities& elasticities);

void print_sensitivity(const sim::Scene& scene, const sim::Interval& answer,
                       const Sensitivity& sensitivity);

/// Keys for a row of an answer: growth, elasticities[], spread, roofline.
Json sensitivity_json(const sim::Interval& answer, const Sensitivity& sensitivity);

}  // namespace leeway::cli
