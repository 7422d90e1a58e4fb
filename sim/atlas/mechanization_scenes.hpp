/// @file
/// The scenes that break mechanizations, clocks and sensors, one in a file each; and what their
/// tests need to know of them.
#pragma once

#include "leeway/rotation.hpp"
#include "leeway/sim/atlas.hpp"

namespace leeway::sim {

inline constexpr double kConingRad = 0.1 * kRadPerDeg;
inline constexpr double kScullingRad = 0.2 * kRadPerDeg;
inline constexpr double kScullingMps2 = 20.0;

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
