/// @file
/// Numbers with their unit, as people type them: 60s, 5min.
#pragma once

#include <CLI/App.hpp>

namespace leeway::cli {

/// Takes a time above zero with one of the units ms, s, min, h behind it, or in s with none, and
/// gives it in s.
/// @param what  for messages: "a time between fixes, such as 60s"
CLI::Validator seconds_quantity(const char* what);

}  // namespace leeway::cli
