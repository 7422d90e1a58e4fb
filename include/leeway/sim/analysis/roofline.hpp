/// @file
/// The roofline of a scene: closed forms of the error just before a fix, one for each thing that
/// makes it. On logarithmic scales they are straight lines, and the error is near the highest. To
/// think with: the analysis is exact, these show why it is so.
#pragma once

#include "leeway/earth/names.hpp"
#include "leeway/sim/scene/scene.hpp"

namespace leeway::sim {

/// Lines of a roofline, each over the time T between fixes.
enum class RooflineTerm {
  kFixPosition,         ///< white noise of the position: T^0.5, then level
  kFixCorrelated,       ///< its correlated error: T^0.25, then level
  kFixVelocity,         ///< noise of the velocity, less what a good IMU averages: up to T
  kAccelerometerNoise,  ///< velocity random walk: T^1.5
  kAccelerometerBias,   ///< what calibration leaves of the turn-on bias: T^2
  kAccelerometerDrift,  ///< random walk of the bias: T^2.5, then T^2
  kGyroNoise,           ///< angular random walk: T^2.5
  kGyroBias,            ///< what calibration leaves of the turn-on bias: T^3
  kGyroDrift,           ///< random walk of the bias: T^3.5, then T^3
};
constexpr auto names(RooflineTerm) {
  return std::array{"fix_position",        "fix_correlated",     "fix_velocity",
                    "accelerometer_noise", "accelerometer_bias", "accelerometer_drift",
                    "gyro_noise",          "gyro_bias",          "gyro_drift"};
}

/// Position variance before a fix, of white noise of unit density into the last of some integrators
/// in a row, where each fix gives position and velocity exactly: times T^5 and T^7.
/// Source: the steady state of the Riccati recursion; docs/theory/analysis/roofline.md.
inline constexpr double kThreeIntegrators = 0.0794627825494;  ///< 1/20 + sqrt(2)/48
inline constexpr double kFourIntegrators = 0.0191867073083;

/// The closed forms of a scene.
///
/// Conditions: position and velocity at each fix; a filter that has settled and knows its sensors;
/// T short beside a Schuler period (84 min); level motion without turns or accelerations. Scale
/// factors, misalignments, heading and the aiding of a vehicle have no line; a metric
/// of the height and a limit that grows with the way have none at all. How far off it is:
/// docs/theory/analysis/roofline.md.
class Roofline {
 public:
  /// @throws Error when the scene is invalid.
  explicit Roofline(const Scene& scene);

  /// A line at an interval, in m by the scene's metric; 0 where the scene lacks its source.
  double error_m(RooflineTerm term, double interval_s) const;

  /// The highest of all lines.
  double roof_m(double interval_s) const;

  /// The root of the sum of their squares: sources are independent.
  double sum_m(double interval_s) const;

  /// The interval at which the roof meets a limit: the least crossing of its lines. NaN unless it
  /// is between 1 ms and 1e6 s.
  double interval_s(double limit_m) const;

  /// The same for the sum, never longer.
  double sum_interval_s(double limit_m) const;

 private:
  double sigma_m(RooflineTerm term, double interval_s) const;
  /// What white noise and random walks of the sensors make of an exact velocity.
  double lost_velocity_mps(double interval_s) const;

  double by_metric_;  ///< of an error of 1 m on each axis
  double duration_s_;
  double position_m_;
  double correlated_m_;
  double correlation_s_;
  double velocity_mps_;
  ImuErrorModel imu_;
  double accelerometer_bias_mps2_;
  double gyro_bias_radps_;
};

}  // namespace leeway::sim
