/// @file
/// An IMU error model as sections of a larger file: [imu.accelerometer] and [imu.gyro] of a scene.
#pragma once

#include "leeway/sensors/imu_error_model.hpp"
#include "sim/tools/toml_reader.hpp"

namespace leeway::sim {

/// Reads the sub-sections accelerometer and gyro of a section; the keys are those of
/// leeway/sim/imu_model_file.hpp. @throws Error as read_imu_model does.
ImuErrorModel read_imu_model(TomlSection& parent);

}  // namespace leeway::sim
