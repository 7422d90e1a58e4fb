/// @file
/// A body that vibrates, sampled at several rates: the grid that coning and sculling share.
#pragma once

#include <functional>
#include <vector>

#include "leeway/sim/motion/trajectory.hpp"
#include "sim/atlas/cells.hpp"

namespace leeway::sim {

/// Of a motion with a frequency, one cell for every scheme, frequency and IMU rate.
/// @param motion  repeats every second
/// @param figure  of the truth and the estimate after so many seconds
std::vector<AtlasCell> vibration_cells(
    const std::function<LocalMotion(double frequency_hz, double t_s)>& motion,
    const std::function<double(const NavState& truth, const NavState& nav, double t_s)>& figure,
    const AtlasOptions& options);

}  // namespace leeway::sim
