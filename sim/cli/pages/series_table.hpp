/// @file
/// Long series of a report, thinned so that the page stays small however long a log is.
#pragma once

#include <initializer_list>
#include <span>
#include <vector>

#include "sim/cli/json.hpp"

namespace leeway::cli {

/// Rows of numbers, at most kMostRows of them: once there are more, neighbours are taken together,
/// two by two as often as it takes.
class SeriesTable {
 public:
  static constexpr std::size_t kMostRows = 16384;

  /// What is kept of rows taken together, beside the first of the first column.
  enum class Keep {
    kExtremes,  ///< the least and the greatest of every column, so that no peak is lost
    kFirst,     ///< the first row
  };

  explicit SeriesTable(std::vector<std::string> columns, Keep keep = Keep::kExtremes)
      : names_(std::move(columns)), keep_(keep) {}

  /// @pre as many values as columns. NaN: missing.
  void add(std::span<const double> row);
  void add(std::initializer_list<double> row) { add({row.begin(), row.size()}); }

  bool empty() const { return rows_.empty(); }

  /// {taken_together, columns: {name: {f64 or f32: base64 of little-endian numbers}}}. A column a
  /// has its greatest values in a_max. Double precision for the first column and short tables.
  Json json() const;

 private:
  /// Rows taken together, by column.
  struct Row {
    std::vector<double> least{};
    std::vector<double> greatest{};
  };

  void take_in(Row& row, const Row& next) const;

  std::vector<std::string> names_;
  Keep keep_;
  std::vector<Row> rows_{};
  std::size_t together_{1};
  std::size_t in_last_{0};  ///< rows in the last of rows_; 0: it is complete
};

}  // namespace leeway::cli
