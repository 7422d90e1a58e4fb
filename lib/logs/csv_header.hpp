/// @file
/// Columns of a CSV log, found by name in its header. Private to the log readers.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/logs/line_reader.hpp"
#include "leeway/logs/log_format.hpp"
#include "lib/logs/log_layout.hpp"
#include "lib/logs/text_fields.hpp"

namespace leeway {

struct NamedColumn {
  std::string_view name;
  Column column;
};

class CsvHeader {
 public:
  /// A line of names with commas between, taken as they are.
  CsvHeader(std::string_view line, std::string path);

  /// The header of a CSV of any dialect, its names and units understood.
  /// @throws Error when two columns mean the same, or a unit is unknown.
  static CsvHeader understood(std::string_view line, std::string path, const LogFormat& format);

  /// The names the header does not have.
  std::vector<std::string_view> missing(std::span<const NamedColumn> wanted) const;
  bool has(std::span<const NamedColumn> wanted) const { return missing(wanted).empty(); }

  /// The names as they stand in the log, without quotes.
  const std::vector<std::string>& titles() const { return titles_; }

  /// Marks the columns for parser(). Those the header lacks are left out.
  /// @throws Error when a wanted name stands there twice.
  void use(std::span<const NamedColumn> wanted);

  /// As use(), but all of them must be there.
  /// @throws Error naming those that are not, and what was expected.
  void require(std::span<const NamedColumn> wanted, const std::string& expected);

  /// As use(), but the columns are there together or not at all: returns whether they are.
  /// @throws Error when only some of them are there.
  bool use_group(std::span<const NamedColumn> wanted);

  /// Times in the unit that the steps between the rows show, where nothing else says it.
  /// @param rows  the first rows of the log
  /// @param slowest_s  the longest plausible time between rows, s
  /// @throws Error when the steps contradict the unit that the header says.
  void settle_time_unit(std::string_view rows, double slowest_s, std::vector<std::string>& notes);

  /// Adds what the owner should know: columns not used, units that nothing says.
  void note(std::vector<std::string>& notes) const;

  LineParser parser(Separator separator) const { return {separator, columns_}; }
  LineParser parser() const { return parser(separator_); }

 private:
  void refuse_linear_acceleration() const;
  std::size_t index_of(std::string_view name) const;
  std::vector<double> steps_of(std::string_view rows) const;

  std::vector<std::string> names_;
  std::vector<std::string> titles_;  // as they stand in the log
  std::vector<double> scales_;
  std::vector<bool> names_unit_;
  std::vector<Column> columns_;
  std::string path_;
  Separator separator_{Separator::kComma};
};

/// The longest time between rows that is believed of a log, s: beyond it the unit is another.
inline constexpr double kSlowestImuS = 0.4;
inline constexpr double kSlowestLogS = 30.0;

/// The header that a log must begin with, its columns marked; the lines then go on behind it.
/// @throws Error when the log is empty or a column is missing, saying what was expected.
CsvHeader take_csv_header(LogOpening& log, std::span<const NamedColumn> wanted,
                          const std::string& expected, double slowest_s = kSlowestLogS);

/// "a, b, c".
std::string join(std::span<const std::string_view> names);
std::string join(std::span<const NamedColumn> columns);

}  // namespace leeway
