/// @file
/// Predefined trajectories: the motions of the studies, and two of the reference vectors. Every
/// factory throws Error, naming the field and its range, unless the duration is > 0 and each
/// parameter is finite and in the range given at it.
#pragma once

#include "leeway/earth/names.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

/// The motions that a study can ask for. The first five have no end of their own.
enum class TrajectoryKind { kStatic, kStraight, kCircle, kSquareLoop, kCar, kWaypoints, kRecorded };
constexpr auto names(TrajectoryKind) {
  return std::array{"static", "straight", "circle", "square-loop", "car", "waypoints", "recorded"};
}

inline constexpr Geodetic kDefaultOrigin{45.0 * kRadPerDeg, 37.6 * kRadPerDeg, 100.0};

/// Parameters of a body at rest on the rotating Earth.
struct StaticParameters {
  Geodetic origin{kDefaultOrigin};
  EulerAngles attitude{};
  double duration_s{3600.0};
};
Trajectory static_trajectory(const StaticParameters& parameters = {});

/// Parameters of a straight line at constant velocity, with the body along it.
struct StraightParameters {
  Geodetic origin{kDefaultOrigin};
  double ground_speed_mps{20.0};  ///< >= 0
  double climb_rate_mps{0.0};
  double heading_rad{0.0};
  double duration_s{600.0};
};
Trajectory straight(const StraightParameters& parameters = {});

/// Parameters of a level right-hand circle through the origin, starting north.
struct CircleParameters {
  Geodetic origin{kDefaultOrigin};
  double radius_m{100.0};  ///< > 0
  double speed_mps{20.0};  ///< >= 0
  double duration_s{600.0};
};
Trajectory circle(const CircleParameters& parameters = {});

/// Parameters of a level square with rounded corners at constant speed, starting north, with right
/// turns. Yaw rate and lateral acceleration jump where straights and turns meet. Four sides close
/// exactly, so the position has no error that grows with time.
struct SquareLoopParameters {
  Geodetic origin{kDefaultOrigin};
  double speed_mps{20.0};   ///< >= 0
  double straight_s{50.0};  ///< time on a straight, >= 0
  double turn_s{10.0};      ///< time of a quarter turn, > 0: 9 deg/s
  double duration_s{14400.0};
};
Trajectory square_loop(const SquareLoopParameters& parameters = {});

/// Parameters of a car on a hilly road in the shape of an eight, 2.4 km a lap, with stops of 10 to
/// 20 s. It is at rest first, so that a filter can level. Its speed is up to 25 m/s, lower in the
/// bends; its acceleration is below 2.5 m/s^2 along and 3.5 m/s^2 across. Slopes are up to 6 %.
/// The body follows the road, whose camber and bumps appear in roll and pitch. The angular
/// acceleration jumps where the car begins or ends to change its speed.
struct CarDriveParameters {
  Geodetic origin{56.0 * kRadPerDeg, 92.8 * kRadPerDeg, 150.0};
  double initial_rest_s{30.0};  ///< >= 0
  double duration_s{1800.0};
};
Trajectory car_drive(const CarDriveParameters& parameters = {});

/// The reference vector circle20: circle() with its defaults, for 60 s.
Trajectory circle20();

/// The reference vector manoeuvre_car: a level eight at 14 to 30 m/s with 1 to 2 Hz body motion,
/// for 100 s.
Trajectory manoeuvre_car();

}  // namespace leeway::sim
