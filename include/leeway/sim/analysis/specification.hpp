/// @file
/// What could be bought better: the numbers of IMU, receiver and aiding that a scene's error comes
/// from, each to be scaled as a whole.
#pragma once

#include <optional>
#include <vector>

#include "leeway/earth/names.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// Specifications. Each is a sigma or a density of all axes, but for the correlation time.
enum class Specification {
  kAccelerometerBias,          ///< at turn-on, and its known part
  kAccelerometerDrift,         ///< in-run, its sigma; the correlation time stays
  kAccelerometerNoise,         ///< density
  kAccelerometerScale,         ///< diagonal of M_a, known and spread
  kAccelerometerMisalignment,  ///< the rest of M_a
  kGyroBias,
  kGyroDrift,
  kGyroNoise,
  kGyroScale,
  kGyroMisalignment,
  kGyroGSensitivity,
  kGnssPosition,         ///< white
  kGnssCorrelated,       ///< sigma of the Gauss-Markov part of the position
  kGnssVelocity,         ///< white
  kGnssCorrelationTime,  ///< of the receiver, and what the filter takes it for
  kStandstill,           ///< what the filter takes rest for: velocity and rate
  kNoSideSlip,           ///< what it takes the constraint of a car for
  kOdometer,             ///< noise and scale
  kBarometer,            ///< noise and weather
  kHeading,              ///< noise of a measured heading
};
constexpr auto names(Specification) {
  return std::array{"accelerometer_bias",
                    "accelerometer_drift",
                    "accelerometer_noise",
                    "accelerometer_scale",
                    "accelerometer_misalignment",
                    "gyro_bias",
                    "gyro_drift",
                    "gyro_noise",
                    "gyro_scale",
                    "gyro_misalignment",
                    "gyro_g_sensitivity",
                    "gnss_position",
                    "gnss_correlated",
                    "gnss_velocity",
                    "gnss_correlation_time",
                    "standstill",
                    "no_side_slip",
                    "odometer",
                    "barometer",
                    "heading"};
}

/// Whether it is one of the IMU's.
constexpr bool is_of_imu(Specification specification) {
  return specification <= Specification::kGyroGSensitivity;
}

/// Whether the scene has it: any of its numbers is above zero, and what it belongs to is used.
bool has(const Scene& scene, Specification specification);

/// All that the scene has, in order.
std::vector<Specification> specifications(const Scene& scene);

/// The scene with a specification multiplied, in the truth and in what the filter takes for it. An
/// error_track() of the scene serves the new one as well.
/// @pre factor > 0.
Scene scaled(Scene scene, Specification specification, double factor);

/// The source of errors that a specification is the sigma of; none of what only the filter is told.
std::optional<ErrorSource> source_of(Specification specification);

}  // namespace leeway::sim
