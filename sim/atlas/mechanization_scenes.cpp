#include "mechanization_scenes.hpp"

#include "scenes.hpp"

namespace leeway::sim {

std::vector<AtlasScene> mechanization_scenes() {
  return {pitch_90(), coning(), sculling(), float_position(), euler_hour()};
}

}  // namespace leeway::sim
