/// @file
/// A motion that was recorded: a smooth curve through a truth or reference log.
#pragma once

#include <filesystem>

#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

struct RecordedParameters {
  std::filesystem::path file{};  ///< layout of TruthLogReader, plain or gzip
  /// Bandwidth: motion up to 0.25 / smoothing_s Hz is kept, that above 1 / smoothing_s, noise
  /// included, is not. 0.01 to 100.
  double smoothing_s{1.0};
  double max_gap_s{3.0};  ///< longest hole that is bridged, by the smoothest curve
  double min_speed_mps{
      1.0};  ///< where a log has no attitude: from here on the course is the heading
};

/// Position and attitude by a spline of degree five with knots every smoothing_s, fitted by least
/// squares; velocity, specific force and angular rate are its derivatives, so those that the log
/// may hold are not used. A log without attitude gives a body that points along its velocity, level
/// across; below min_speed_mps its heading and pitch go evenly from where it was last fast enough
/// to where it is next. The time starts with the first row. breaks_s are the knots, where a fifth
/// derivative jumps; angles are whole jets.
/// @throws Error naming the file, and the line where it can, when the log cannot be read or has a
/// damaged line, a hole longer than max_gap_s, less than 10 rows or 2 smoothing_s, more than 5e6
/// rows or 1e6 s, rows with and without attitude, a pitch beyond 80 deg, or goes further than
/// 7000 km from its start.
Trajectory recorded_trajectory(const RecordedParameters& parameters);

}  // namespace leeway::sim
