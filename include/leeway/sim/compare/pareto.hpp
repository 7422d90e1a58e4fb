/// @file
/// Which of many candidates, each with a cost and an error, nobody need consider.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace leeway::sim {

/// A measured cost with its spread, and an error. An error that is not finite is out of the
/// contest: it neither dominates nor is dominated.
struct ParetoPoint {
  double cost{};
  double least_cost{};
  double most_cost{};
  double error{};
};

/// Errors closer together than this part of them are alike.
inline constexpr double kErrorResolution = 1e-3;

/// Whether a is no worse than b in both and better in one. Cheaper is better only when the spreads
/// do not overlap; a lower error only by more than kErrorResolution. Chains of domination never
/// close, so somebody is always left.
bool dominates(const ParetoPoint& a, const ParetoPoint& b);

/// The cheapest of those that dominate each point; empty on the front and out of the contest.
std::vector<std::optional<std::size_t>> dominators(const std::vector<ParetoPoint>& points);

}  // namespace leeway::sim
