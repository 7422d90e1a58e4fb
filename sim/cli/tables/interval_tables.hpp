/// @file
/// What `leeway interval` says.
#pragma once

#include <vector>

#include "sim/cli/commands/interval_confirm.hpp"
#include "sim/cli/json.hpp"

namespace leeway::cli {

void print_interval_tables(const std::vector<SolvedImu>& solved);

/// By the contract of --json.
Json interval_json(const std::vector<SolvedImu>& solved);

}  // namespace leeway::cli
