#include "estimator_scenes.hpp"

#include "scenes.hpp"

namespace leeway::sim {

std::vector<AtlasScene> estimator_scenes() {
  return {positive_definiteness(), dead_row(), frozen_transition()};
}

}  // namespace leeway::sim
