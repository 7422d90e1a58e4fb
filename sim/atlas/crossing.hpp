/// @file
/// An airliner across a place where latitude and longitude fail: what the scenes of the pole and of
/// the antimeridian share.
#pragma once

#include <string>
#include <vector>

#include "leeway/sim/scene/scene.hpp"
#include "sim/atlas/cells.hpp"

namespace leeway::sim {

/// From the one place to the other at 250 m/s and 11 km, along the great ellipse, on a tactical IMU
/// at 50 Hz with a fix every second.
Scene crossing(const Geodetic& from, const Geodetic& to);

/// Strapdowns on perfect increments, those in latitude and longitude too: error of the position at
/// the end.
std::vector<AtlasCell> crossed_without_fixes(const Scene& scene, const std::string& condition);

/// Filters with fixes: RMS error of the position before each.
std::vector<AtlasCell> crossed_with_fixes(const Scene& scene, const std::string& condition,
                                          int trials);

/// A strapdown in latitude and longitude, corrected by a share of the true position every second;
/// 0: never.
AtlasCell crossed_in_latitude_and_longitude(const Scene& scene, const std::string& condition,
                                            double share);

/// Of both scenes.
AtlasLimits crossing_limits();

}  // namespace leeway::sim
