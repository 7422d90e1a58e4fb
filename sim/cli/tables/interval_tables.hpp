/// @file
/// What `leeway interval` says.
#pragma once

#include "sim/cli/json.hpp"
#include "sim/trials/confirmation.hpp"

namespace leeway::cli {

struct SolvedImu {
  sim::Scene scene{};
  std::vector<sim::Interval> intervals{};
  /// As intervals; empty: not asked for.
  std::vector<std::optional<sim::Confirmation>> confirmations{};
};

void print_interval_tables(const std::vector<SolvedImu>& solved);

/// By the contract of --json.
Json interval_json(const std::vector<SolvedImu>& solved);

}  // namespace leeway::cli
