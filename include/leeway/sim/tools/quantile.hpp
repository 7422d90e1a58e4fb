/// @file
/// Quantiles of what trials found.
#pragma once

#include <vector>

namespace leeway::sim {

/// The smallest of the values that so great a share of them does not exceed; NaN without any.
double quantile_of(std::vector<double> values, double probability);

}  // namespace leeway::sim
