/// @file
/// What leeway atlas --mismatch writes.
#pragma once

#include <string>

#include "sim/atlas/mismatch/mismatch.hpp"
#include "sim/cli/json.hpp"

namespace leeway::cli {

/// How many are lost and how many claims do not hold; then the cells, the worst first.
void print_mismatch(const sim::MismatchCampaign& campaign);

Json mismatch_json(const sim::MismatchCampaign& campaign);

/// docs/guide/mismatch.md.
std::string mismatch_markdown(const sim::MismatchCampaign& campaign);

}  // namespace leeway::cli
