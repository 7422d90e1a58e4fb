/// @file
/// A body that vibrates, sampled at several rates: the grid that coning and sculling share.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "leeway/sim/atlas.hpp"
#include "leeway/sim/trajectory.hpp"
#include "leeway/strapdown.hpp"

namespace leeway::sim {

/// Of a motion with a frequency, one cell for every scheme, frequency and IMU rate.
/// @param motion  repeats every second
/// @param figure  of the truth and the estimate after so many seconds
std::vector<AtlasCell> vibration_cells(
    const std::function<Trajectory(double frequency_hz)>& motion,
    const std::function<double(const NavState& truth, const NavState& nav, double t_s)>& figure,
    const AtlasOptions& options);

/// What a scheme leaves out of a vibration of two axes of which each is a sine, over what the
/// motion makes: 1 - sin x / x for one sample, x the phase from one increment to the next; of two
/// samples what their 1/12 does not give back. To second order in the angle. Source: Savage (1998),
/// part 1, section VIII, on the coning term over one increment.
double vibration_left_out(Scheme scheme, double frequency_hz, double imu_rate_hz);

}  // namespace leeway::sim
