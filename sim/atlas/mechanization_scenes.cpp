#include "sim/atlas/mechanization_scenes.hpp"

#include "sim/atlas/scenes.hpp"

namespace leeway::sim {

std::vector<AtlasScene> mechanization_scenes() {
  return {pitch_90(),  pole(),         antimeridian(), float_position(),
          coning(),    sculling(),     euler_hour(),   split_intervals(),
          fix_order(), clock_faults(), unit_slips(),   under_modelled()};
}

}  // namespace leeway::sim
