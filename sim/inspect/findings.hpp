/// @file
/// What figures of logs mean: findings, each with its remedy.
#pragma once

#include <vector>

#include "leeway/sim/inspect/log_look.hpp"
#include "sim/inspect/shared_turns.hpp"

namespace leeway::sim {

/// Correlation of turns from which those of two logs are the same.
inline constexpr double kSameTurns = 0.8;

/// Of one IMU log: unit of the specific force, channels, gaps.
std::vector<Finding> imu_findings(const ImuFigures& imu);

/// Whether the accelerometers tell which way is down.
bool has_gravity(const ImuFigures& imu);

/// Of the axes that gravity and speed changes show.
std::vector<Finding> axes_findings(const ImuFigures& imu);

/// Of one GNSS log: repetitions, claims, lag.
std::vector<Finding> fix_findings(const FixFigures& gnss);

/// Of two logs' times.
std::vector<Finding> time_line_findings(const TimeFigures& imu, const TimeFigures& gnss);

/// Of the turns that both logs have: unit and signs of the gyros, the clocks.
std::vector<Finding> turn_findings(const TurnMatch& turns, const SharedFigures& shared,
                                   double imu_step_s);

/// Of an odometer's speed over the receiver's.
std::vector<Finding> odometer_findings(double ratio);

}  // namespace leeway::sim
