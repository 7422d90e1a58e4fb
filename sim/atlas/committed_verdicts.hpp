/// @file
/// The text of expected.csv, compiled in.
#pragma once

#include <string_view>

namespace leeway::sim {

extern const std::string_view kCommittedVerdicts;

}  // namespace leeway::sim
