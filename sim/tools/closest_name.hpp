/// @file
/// What somebody who mistyped a name may have meant.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace leeway::sim {

/// Levenshtein distance of the first 64 characters, blind to case.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name that was meant: a spelling nearly the same, else one whose words mean the same, as
/// "interval" does what "rate" does. Empty: none is near.
std::string_view meant_by(std::string_view wrong, std::span<const std::string_view> accepted);

/// "did you mean 'gyro'? Accepted: accelerometer, gyro"; without the question where none is near.
std::string did_you_mean(std::string_view wrong, std::span<const std::string_view> accepted);

}  // namespace leeway::sim
