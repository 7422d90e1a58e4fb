/// @file
/// A recorded motion: a smooth curve through a truth or reference log.
#pragma once

#include <filesystem>
#include <vector>

#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

/// Parameters of the curve through a log.
struct RecordedParameters {
  std::filesystem::path file{};  ///< layout of TruthLogReader, plain or gzip
  /// Bandwidth, 0.01 to 100: motion up to 0.25 / smoothing_s Hz is kept. Motion and noise above
  /// 1 / smoothing_s Hz are removed.
  double smoothing_s{1.0};
  double max_gap_s{3.0};  ///< longest hole in the log that the smoothest curve may fill
  /// Least speed at which the course is the heading, in a log without attitude.
  double min_speed_mps{1.0};
};

/// Position and attitude as a spline of degree five with knots every smoothing_s, fitted by least
/// squares. Velocity, specific force and angular rate are its derivatives; those of the log are not
/// used. Time 0 is the first row. breaks_s are the knots, where the fifth derivative jumps. Angles
/// have both derivatives.
///
/// A log without attitude gives a body that points along its velocity, level across. While the body
/// is slower than min_speed_mps, heading and pitch change evenly from their last values to the
/// next.
/// @throws Error naming the file, and the line if known. The log must be readable, without damaged
/// lines and without holes longer than max_gap_s. It must have at least 10 rows and 2 smoothing_s,
/// at most 5e6 rows and 1e6 s, and attitude in all rows or in none. Its pitch must stay within
/// 80 deg, its position within 7000 km of the start.
Trajectory recorded_trajectory(const RecordedParameters& parameters);

/// The same through rows in memory, in the order of time, all with attitude.
/// @param parameters  of which the file is a name alone
Trajectory recorded_trajectory(const std::vector<NavStateNed>& rows,
                               const RecordedParameters& parameters);

}  // namespace leeway::sim
