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

/// Place in a Table 1 range: its low end, geometric mean, or high end.
enum class RangeEnd { kLow, kMid, kHigh };
constexpr auto names(RangeEnd) { return std::array{"low", "mid", "high"}; }

/// Error model of a class. Biases are random constants with the Table 1 drift as their 1-sigma;
/// there are no scale errors. A bound "< x" is read as the range x/4 to x, "> x" as x alone.
ImuErrorModel imu_class_model(ImuClass c, RangeEnd end);

/// The Table 1 class of each of the four quantities that the table has.
struct ImuClassification {
  ImuClass accelerometer_drift{};
  ImuClass gyro_drift{};
  ImuClass accelerometer_noise{};
  ImuClass gyro_noise{};
  ImuClass overall{};  ///< the worst of the four
};

/// Classes of a model: of each value the one whose range is nearest on a logarithmic scale. Of two
/// as near it is the better one; zero is marine. The drift is the 1-sigma bias at the start,
/// turn-on and in-run together.
ImuClassification classify(const ImuErrorModel& model);

/// Error model of a car-grade MEMS part, as a filter should see it while driving. Better than the
/// automotive class of Table 1 by 20 years of sensors, but for its bias at turn-on:
///
/// - turn-on bias 0.5 deg/s and 0.3 m/s^2, 1 sigma;
/// - in-run drift 0.01 deg/s and 0.005 m/s^2, 1 sigma, over 300 s;
/// - noise 0.3 deg/sqrt(h) and 0.1 m/s/sqrt(h), above a datasheet's to make room for scale factors
///   and vibration.
ImuErrorModel automotive_mems_model();

}  // namespace leeway
