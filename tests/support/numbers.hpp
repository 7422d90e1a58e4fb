/// @file
/// Numbers that tests feed to what must bear or refuse them.
#pragma once

#include <limits>

namespace leeway::test {

inline constexpr double kInf = std::numeric_limits<double>::infinity();
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace leeway::test
