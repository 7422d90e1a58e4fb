/// @file
/// The door for recorded data: readers of IMU, GNSS, truth and scalar logs, writers of solutions.
#pragma once

#include "leeway/logs/csv_writer.hpp"
#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"
#include "leeway/logs/scalar_log.hpp"
#include "leeway/logs/solution_writer.hpp"
#include "leeway/logs/truth_log.hpp"
