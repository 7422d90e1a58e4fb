/// @file
/// What leeway atlas --faults writes.
#pragma once

#include <string>

#include "sim/atlas/faults/fault_matrix.hpp"
#include "sim/cli/json.hpp"

namespace leeway::cli {

/// Faults by vehicles, with a word a cell, and the summary.
void print_faults(const sim::FaultMatrix& matrix);

Json faults_json(const sim::FaultMatrix& matrix);

/// docs/guide/fault-matrix.md.
std::string faults_markdown(const sim::FaultMatrix& matrix);

}  // namespace leeway::cli
