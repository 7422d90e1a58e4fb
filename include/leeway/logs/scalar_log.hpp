/// @file
/// Logs of one quantity over time, such as a speed: a streaming reader.
#pragma once

#include <filesystem>
#include <string>

#include "leeway/earth/time.hpp"
#include "leeway/logs/log_reader.hpp"

namespace leeway {

/// One row; sigma is NaN where the log has none.
struct ScalarRecord {
  Time time{};
  double value{};
  double sigma{};
};

/// Names and bounds of the columns.
struct ScalarColumns {
  std::string value{};
  std::string sigma{};  ///< may be missing in the log, or empty in a row
  double largest{};     ///< of the value's magnitude, and of the sigma
};

/// Reader of CSV logs of one quantity, columns found by name in any order: t_s and the value's,
/// and, or not, its standard deviation.
class ScalarLogReader : public LogReader<ScalarRecord> {
 public:
  /// @throws Error when the file cannot be read, is empty or lacks columns (naming them).
  ScalarLogReader(const std::filesystem::path& path, const ScalarColumns& columns);
};

}  // namespace leeway
