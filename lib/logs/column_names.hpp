/// @file
/// Names that loggers give to columns, and their units. Private to the log readers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "leeway/logs/log_format.hpp"

namespace leeway {

/// What a column of a CSV is: one of ours, in some unit.
struct ColumnMeaning {
  std::string column{};   ///< Leeway's name, or the name as it stands where it has none
  double scale{1.0};      ///< from the log's unit to that of Leeway's name
  bool names_unit{true};  ///< whether the log or its owner says the unit
  bool is_alias{false};   ///< another name than Leeway's
};

/// The meaning of a title such as `gyro_x [deg/s]`, `acc_x_g` or `time_ms`.
/// @throws Error when the unit, or one of the format, is not one of what the column holds.
ColumnMeaning meaning_of(std::string_view title, const LogFormat& format);

}  // namespace leeway
