/// @file
/// What scenes call the IMU of a Table 1 class: "tactical/mid".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "leeway/sensors/imu_class.hpp"

namespace leeway::sim {

/// A class and the place in its range.
struct ClassAndRange {
  ImuClass imu_class{};
  RangeEnd range{RangeEnd::kMid};
};

std::string imu_name(const ClassAndRange& imu);

/// Of such a name; nothing of any other.
std::optional<ClassAndRange> class_of_name(std::string_view imu);

}  // namespace leeway::sim
