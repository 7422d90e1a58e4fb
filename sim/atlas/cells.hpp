/// @file
/// The frame of every scene: its cells, condition by condition.
#pragma once

#include <vector>

#include "leeway/sim/atlas/atlas.hpp"

namespace leeway::sim {

inline void append(std::vector<AtlasCell>& cells, const std::vector<AtlasCell>& more) {
  cells.insert(cells.end(), more.begin(), more.end());
}

/// The cells that a function makes of each condition, in their order.
template <class Condition, class CellsOf>
std::vector<AtlasCell> cells_over(const std::vector<Condition>& conditions, CellsOf&& cells_of) {
  std::vector<AtlasCell> cells;
  for (const Condition& condition : conditions) append(cells, cells_of(condition));
  return cells;
}

}  // namespace leeway::sim
