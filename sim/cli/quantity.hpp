/// @file
/// Numbers with their unit, as people type them: 60s, 5min.
#pragma once

#include <CLI/App.hpp>
#include <span>

#include "leeway/earth/units.hpp"

namespace leeway::cli {

/// Takes a number above zero with one of the units behind it, or with none, and gives it in SI.
/// @param units  the first is what a bare number is in
/// @param what   for messages: "a time between fixes, such as 60s"
CLI::Validator quantity(std::span<const Unit> units, const char* what);

/// "60s" or "60": ms, s, min, h.
CLI::Validator seconds_quantity(const char* what);

}  // namespace leeway::cli
