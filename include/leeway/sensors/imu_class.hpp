/// @file
/// The five IMU classes of [seed Table 1].
#pragma once

#include "leeway/earth/names.hpp"
#include "leeway/sensors/imu_error_model.hpp"

namespace leeway {

enum class ImuClass { kMarine, kAviation, kIntermediate, kTactical, kAutomotive };
constexpr auto names(ImuClass) {
  return std::array{"marine", "aviation", "intermediate", "tactical", "automotive"};
}

/// Where in a Table 1 range: its low end, geometric mean, or high end.
enum class RangeEnd { kLow, kMid, kHigh };
constexpr auto names(RangeEnd) { return std::array{"low", "mid", "high"}; }

/// Biases are random constants with the Table 1 drift as their 1-sigma; no scale errors. A bound
/// given as "< x" is read as the range x/4 to x, one given as "> x" as x alone.
ImuErrorModel imu_class_model(ImuClass c, RangeEnd end);

/// The Table 1 class of each of the four quantities that the table has.
struct ImuClassification {
  ImuClass accelerometer_drift{};
  ImuClass gyro_drift{};
  ImuClass accelerometer_noise{};
  ImuClass gyro_noise{};
  ImuClass overall{};  ///< the worst of the four
};

/// A value belongs to the class whose range is nearest on a logarithmic scale, inside a range or
/// not; where two are as near, to the better one. The drift is the 1-sigma bias at the start,
/// turn-on and in-run together. A value of zero is marine.
ImuClassification classify(const ImuErrorModel& model);

/// A car-grade MEMS part as a filter should see it while driving: turn-on bias 0.5 deg/s and
/// 0.3 m/s^2; in-run drift 0.02 deg/s and 0.03 m/s^2 over 300 s; noise 0.3 deg/sqrt(h) and
/// 0.1 m/s/sqrt(h), above a datasheet's to make room for scale factors and vibration. Better than
/// the automotive class of Table 1 by 20 years of sensors, but for its bias at turn-on.
ImuErrorModel automotive_mems_model();

}  // namespace leeway
