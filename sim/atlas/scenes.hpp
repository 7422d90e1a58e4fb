/// @file
/// The scenes of the atlas. A file of estimators/ (what breaks filters) or mechanizations/ (what
/// breaks strapdowns, clocks and sensors) defines the function of its name here, such as
/// `AtlasScene parked_rtk()`; sim/atlas/CMakeLists.txt lists them.
#pragma once

#include <vector>

#include "leeway/sim/atlas/atlas.hpp"

namespace leeway::sim::scenes {

/// The scene of every file, in no order.
std::vector<AtlasScene> all();

}  // namespace leeway::sim::scenes
