/// @file
/// What `leeway interval` says.
#pragma once

#include "leeway/sim/analysis/coast.hpp"
#include "sim/cli/json.hpp"
#include "sim/cli/tables/elasticity_tables.hpp"
#include "sim/trials/confirmation.hpp"

namespace leeway::cli {

/// An answer and what stands behind it.
struct SolvedLimit {
  sim::Interval interval{};
  std::optional<sim::Confirmation> confirmation{};  ///< absent: by the linear analysis alone
  std::string failure{};                            ///< why trials could not be run, or empty
  std::optional<Sensitivity> sensitivity{};         ///< absent: not asked for

  sim::Mark mark() const { return confirmation ? confirmation->mark() : sim::Mark::kLinear; }
  /// What is to be relied on: the trials' where they contradict; NaN where nothing keeps the limit.
  double interval_s() const;
};

/// What the scene's navigator has from the vehicle, and the interval that this gives, linear.
struct AidedInterval {
  std::string aiding{};
  bool is_the_scenes{};  ///< the set that the scene has
  sim::Interval interval{};
};

struct SolvedImu {
  sim::Scene scene{};
  std::vector<SolvedLimit> limits{};
  std::vector<sim::Coast> coasts{};        ///< of a scene that scripts outages; it has no limits
  std::vector<AidedInterval> aided{};      ///< of the scene's own IMU at its own limit
};

void print_interval_tables(const std::vector<SolvedImu>& solved);

/// By the contract of --json.
Json interval_json(const std::vector<SolvedImu>& solved);

}  // namespace leeway::cli
