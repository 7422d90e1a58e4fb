/// @file
/// The scenes that break estimators, one file each.
#pragma once

#include "leeway/sim/atlas/atlas.hpp"

namespace leeway::sim {

AtlasScene bad_covariance();
AtlasScene correlated_fixes();
AtlasScene dead_row();
AtlasScene edited_gain();
AtlasScene fix_bursts();
AtlasScene frozen_transition();
AtlasScene gate_lockout();
AtlasScene lever_arm();
AtlasScene lost_noise();
AtlasScene parked_rtk();
AtlasScene positive_definiteness();
AtlasScene stale_covariance();
AtlasScene stationary_heading();
AtlasScene vertical_channel();
AtlasScene wrong_heading();

}  // namespace leeway::sim
