/// @file
/// IMU error models in TOML files, as a datasheet states them: every key carries its unit.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "leeway/sensors/imu_error_model.hpp"

namespace leeway::sim {

/// The error model in the sections [accelerometer] and [gyro] of a file. Absent values are zero; an
/// absent range is infinite.
///   bias              3 numbers: known constant part    accelerometer: mps2 | mg | ug
///   bias_sigma        turn-on spread                    gyro: deg_per_h | deg_per_s | radps
///   in_run_sigma      of the drift within a run, together with in_run_tau_s
///   noise             accelerometer: ug_per_sqrt_hz | mps_per_sqrt_h
///                     gyro: deg_per_sqrt_h | dps_per_sqrt_hz
///   scale_ppm         1 or 3 numbers: scale factor error
///   scale_sigma_ppm   its spread from unit to unit
///   misalignment_mrad 6 numbers (xy, xz, yx, yz, zx, zy) or 3 x 3 with a zero diagonal
///   misalignment_sigma_mrad                             spread of each of them
///   quantum           LSB of the increment              accelerometer: mps, gyro: rad | arcsec
///   range             saturation                        accelerometer: mps2 | g, gyro: deg_per_s
///   g_sensitivity_deg_per_h_per_g                       gyro: 1 number (diagonal) or 3 x 3
///   g_sensitivity_sigma_deg_per_h_per_g                 gyro: spread of each of its elements
/// The key is the name and the unit, as in bias_sigma_mg. g is 9.80665 m/s^2.
/// @throws Error with path:line:column when the file is unreadable or no TOML, has an unknown key
/// or two keys for one quantity, has a value of a wrong type or beyond any real sensor, or values
/// that contradict each other. The message names the closest key, or the unit that would be
/// plausible.
ImuErrorModel read_imu_model(const std::filesystem::path& path);

/// The error model in a text. @param name  name of the text in messages
ImuErrorModel parse_imu_model(std::string_view text, const std::string& name);

}  // namespace leeway::sim
