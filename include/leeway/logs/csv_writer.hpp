/// @file
/// CSV output: a time and numbers per row. A half-written file is never left under the final name.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "leeway/earth/time.hpp"

namespace leeway {

class TextFile;

/// A column and how its numbers are written.
struct CsvColumn {
  static constexpr int kExact = -1;   ///< shortest text that reads back as the same double
  static constexpr int kSingle = -2;  ///< as kExact after rounding to single precision: 6e-8

  CsvColumn(const char* column_name, int column_decimals = kExact)
      : name(column_name), decimals(column_decimals) {}

  std::string name;
  int decimals;  ///< 0 to 12 digits after the point, or one of the above
};

/// Writer of a CSV file, gzip when the name ends in .gz. It writes `path`.partial and renames it to
/// `path` on close(); destroyed without close() it leaves neither. NaN and infinities are written
/// as "nan" and "inf".
class CsvWriter {
 public:
  /// The first column is the time, written to the nanosecond whatever its decimals.
  /// @throws Error when the file cannot be created.
  CsvWriter(const std::filesystem::path& path, const std::vector<CsvColumn>& columns);
  ~CsvWriter();
  CsvWriter(CsvWriter&&) noexcept;
  CsvWriter& operator=(CsvWriter&&) = delete;

  /// Row of a time and the other columns' values.
  /// @throws Error when the count is not that of the columns or on a write failure.
  void write(Time time, std::span<const double> values);

  /// Finishes the file. @throws Error when it cannot be written completely.
  void close();

 private:
  std::unique_ptr<TextFile> file_;
  std::vector<int> decimals_{};
};

}  // namespace leeway
