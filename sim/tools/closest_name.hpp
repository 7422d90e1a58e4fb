/// @file
/// What somebody who mistyped a name may have meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace leeway::sim {

/// Levenshtein distance of the first 64 characters, blind to case.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// "did you mean 'gyro'? Accepted: accelerometer, gyro"
std::string did_you_mean(std::string_view wrong, std::span<const std::string_view> accepted);

}  // namespace leeway::sim
