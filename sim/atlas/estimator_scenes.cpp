#include "sim/atlas/estimator_scenes.hpp"

#include "sim/atlas/scenes.hpp"

namespace leeway::sim {

std::vector<AtlasScene> estimator_scenes() {
  return {positive_definiteness(),
          edited_gain(),
          lost_noise(),
          parked_rtk(),
          stationary_heading(),
          wrong_heading(),
          correlated_fixes(),
          stale_covariance(),
          fix_bursts(),
          gate_lockout(),
          frozen_transition(),
          vertical_channel(),
          lever_arm(),
          dead_row(),
          bad_covariance()};
}

}  // namespace leeway::sim
