/// @file
/// The scenes that break mechanizations, clocks and sensors, one file each.
#pragma once

#include "leeway/sim/atlas/atlas.hpp"

namespace leeway::sim {

AtlasScene antimeridian();
AtlasScene clock_faults();
AtlasScene coning();
AtlasScene euler_hour();
AtlasScene fix_order();
AtlasScene float_position();
AtlasScene pitch_90();
AtlasScene pole();
AtlasScene sculling();
AtlasScene split_intervals();
AtlasScene under_modelled();
AtlasScene unit_slips();

}  // namespace leeway::sim
