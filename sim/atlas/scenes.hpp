/// @file
/// The scenes of the atlas, one function in one file each.
#pragma once

#include <vector>

#include "leeway/sim/atlas/atlas.hpp"

namespace leeway::sim {

/// What breaks estimators.
std::vector<AtlasScene> estimator_scenes();

/// What breaks mechanizations, clocks and sensors.
std::vector<AtlasScene> mechanization_scenes();

}  // namespace leeway::sim
