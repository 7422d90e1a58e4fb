#include "sim/inspect/known_factors.hpp"

#include <cmath>

namespace leeway::sim {

std::optional<KnownFactor> known_factor(std::span<const KnownFactor> factors, double factor,
                                        double tolerance) {
  std::optional<KnownFactor> nearest;
  for (const KnownFactor& known : factors) {
    const double off = std::abs(factor / known.factor - 1.0);
    if (off > tolerance) continue;
    tolerance = off;
    nearest = known;
  }
  return nearest;
}

}  // namespace leeway::sim
