#include "scenes.hpp"

namespace leeway::sim {

std::vector<AtlasScene> mechanization_scenes() { return {}; }

}  // namespace leeway::sim
