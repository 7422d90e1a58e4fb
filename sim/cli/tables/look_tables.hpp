/// @file
/// What a look at logs found, as tables and as JSON.
#pragma once

#include "leeway/sim/inspect/log_look.hpp"
#include "sim/cli/answer.hpp"

namespace leeway::cli {

/// A line each: how sure, what, and the option that mends it. Nothing of none.
void print_findings(const std::vector<sim::Finding>& findings);

void print_figures(const sim::LogLook& look);

/// Figures and findings.
Json look_json(const sim::LogLook& look);

Json findings_json(const std::vector<sim::Finding>& findings);

}  // namespace leeway::cli
