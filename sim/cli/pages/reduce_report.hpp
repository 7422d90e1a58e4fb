/// @file
/// How a budget is shown: tables and JSON. Part of the budget command.
#pragma once

#include <string>

#include "leeway/sim/reduce/model_reduction.hpp"
#include "sim/cli/output.hpp"

namespace leeway::cli {

void print_model_budget(const sim::ModelReduction& budget, int repeat);

Json model_budget_json(const sim::ModelReduction& budget);

/// What the reduced filter is, for the top of its file.
std::string model_budget_comment(const sim::ModelReduction& budget);

}  // namespace leeway::cli
