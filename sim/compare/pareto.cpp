#include "leeway/sim/compare/pareto.hpp"

#include <cmath>

namespace leeway::sim {

bool dominates(const ParetoPoint& a, const ParetoPoint& b) {
  if (!std::isfinite(a.error) || !std::isfinite(b.error)) return false;
  const bool is_cheaper = a.most_cost < b.least_cost;
  const bool errs_less = a.error < b.error * (1.0 - kErrorResolution);
  const bool errs_no_more = a.error <= b.error * (1.0 + kErrorResolution);
  return (is_cheaper && errs_no_more) || (errs_less && a.cost <= b.cost);
}

std::vector<std::optional<std::size_t>> dominators(const std::vector<ParetoPoint>& points) {
  std::vector<std::optional<std::size_t>> result(points.size());
  for (std::size_t b = 0; b < points.size(); ++b) {
    for (std::size_t a = 0; a < points.size(); ++a) {
      if (!dominates(points[a], points[b])) continue;
      if (!result[b] || points[a].cost < points[*result[b]].cost) result[b] = a;
    }
  }
  return result;
}

}  // namespace leeway::sim
