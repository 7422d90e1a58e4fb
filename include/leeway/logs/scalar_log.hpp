/// @file
/// Logs of one quantity over time, such as a speed: a streaming reader.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "leeway/earth/time.hpp"
#include "leeway/logs/log_summary.hpp"

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

/// Streams a plain or gzip CSV, columns found by name in any order: t_s and the value's, and, or
/// not, its standard deviation. A damaged line costs that line.
class ScalarLogReader {
 public:
  /// @throws Error when the file cannot be read, is empty or lacks columns (naming them).
  ScalarLogReader(const std::filesystem::path& path, const ScalarColumns& columns);
  ~ScalarLogReader();
  ScalarLogReader(ScalarLogReader&&) noexcept;
  ScalarLogReader& operator=(ScalarLogReader&&) noexcept;

  /// The next row, later than the one before; nothing at the end.
  std::optional<ScalarRecord> next();

  const LogSummary& report() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace leeway
