/// @file
/// Numbers in the fields of a text line. Private to the log readers.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "leeway/earth/time.hpp"
#include "leeway/logs/log_summary.hpp"

namespace leeway {

/// A damaged field: `text` is a view into its line.
struct Fault {
  LineDamage reason{};
  std::string_view text{};
};

enum class Separator {
  kComma,  ///< a field may be empty, blanks around it do not count
  kRuns,   ///< blanks, commas and semicolons, any number of them
};

/// What to do with a column of the file.
struct Column {
  static constexpr int kIgnored = -1;
  static constexpr int kTime = -2;

  int slot{kIgnored};  ///< index of the value it fills
  double min{-std::numeric_limits<double>::max()};
  double max{std::numeric_limits<double>::max()};
  bool optional{false};  ///< NaN, empty and absent are allowed, and read as NaN
};

/// Reads the wanted columns of a line.
class LineParser {
 public:
  LineParser() = default;
  LineParser(Separator separator, std::vector<Column> columns);

  /// Fills time and values; what it leaves behind after a fault is of no use.
  std::optional<Fault> parse(std::string_view line, Time& time, std::span<double> values) const;

 private:
  template <Separator separator>
  std::optional<Fault> parse_fields(std::string_view line, Time& time,
                                    std::span<double> values) const;

  Separator separator_{Separator::kComma};
  std::vector<Column> columns_;
};

/// Fills a row from a line, or tells what is wrong with it.
template <class Row>
using RowParser = std::function<std::optional<Fault>(std::string_view line, Row& row)>;

/// Decimal seconds at the start of the text, to the nearest nanosecond: exact where a double would
/// round, as for seconds since 1980. On success moves `first` behind it.
std::optional<LineDamage> parse_time(const char*& first, const char* last, Time& time);

/// The fields of a line, separated by any of the given characters; blanks around a field are
/// trimmed. With Separator::kRuns no field is empty.
std::vector<std::string_view> split_fields(std::string_view line, Separator separator);

bool is_number(std::string_view text);

}  // namespace leeway
