/// @file
/// What `leeway reduce` prints and writes.
#pragma once

#include <string>

#include "leeway/sim/reduce/model_reduction.hpp"
#include "sim/cli/json.hpp"

namespace leeway::cli {

void print_reduction(const sim::ModelReduction& reduction, int repeat);

Json reduction_json(const sim::ModelReduction& reduction);

/// What the reduced filter is, for the top of its file.
std::string reduction_comment(const sim::ModelReduction& reduction);

}  // namespace leeway::cli
