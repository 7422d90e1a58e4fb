/// @file
/// What `leeway compare` prints and writes.
#pragma once

#include "leeway/sim/compare/compare.hpp"
#include "sim/cli/json.hpp"

namespace leeway::cli {

/// The front, then every variant with what dominates it.
void print_comparison(const sim::Comparison& comparison, int repeat);

Json comparison_json(const sim::Comparison& comparison);

}  // namespace leeway::cli
