/// @file
/// Numbers in the fields of a text line. Private to the log readers.
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/earth/time.hpp"
#include "leeway/logs/log_summary.hpp"

namespace leeway {

/// A damaged field: `text` is a view into its line, or names the field of a message.
struct Fault {
  LineDamage reason{};
  std::string_view text{};
  bool is_damage{true};
  bool is_row{false};
};

/// A line that completes no row, and is as it should be.
inline constexpr Fault kNoRow{.reason = {}, .text = {}, .is_damage = false};

/// A row, and more of them in the same line: the parser is to be asked with it again.
inline constexpr Fault kRowAndMore{.reason = {}, .text = {}, .is_damage = false, .is_row = true};

enum class Separator {
  kComma,      ///< a field may be empty, blanks around it do not count
  kSemicolon,  ///< as kComma; a comma in a number is then the decimal point
  kTab,        ///< likewise
  kRuns,       ///< blanks, commas and semicolons, any number of them
};

/// What to do with a column of the file.
struct Column {
  static constexpr int kIgnored = -1;
  static constexpr int kTime = -2;

  int slot{kIgnored};  ///< index of the value it fills
  double min{-std::numeric_limits<double>::max()};
  double max{std::numeric_limits<double>::max()};
  bool optional{false};  ///< NaN, empty and absent are allowed, and read as NaN
  double scale{1.0};     ///< from the file's unit to ours; of time, seconds per count
};

/// Reads the wanted columns of a line.
class LineParser {
 public:
  LineParser() = default;
  LineParser(Separator separator, std::vector<Column> columns);

  /// Fills time and values; what it leaves behind after a fault is of no use.
  std::optional<Fault> parse(std::string_view line, Time& time, std::span<double> values) const;

 private:
  std::optional<Fault> parse_plain(std::string_view line, Time& time,
                                   std::span<double> values) const;
  template <Separator separator>
  std::optional<Fault> parse_fields(std::string_view line, Time& time,
                                    std::span<double> values) const;

  Separator separator_{Separator::kComma};
  std::vector<Column> columns_;
};

/// Fills a row from a line or a message, or tells what is wrong with it. At the end it is asked
/// with an empty line for what it may still hold.
template <class Row>
using RowParser = std::function<std::optional<Fault>(std::string_view line, Row& row)>;

/// Decimal seconds at the start of the text, to the nearest nanosecond: exact where a double would
/// round, as for seconds since 1980. On success moves `first` behind it.
std::optional<LineDamage> parse_time(const char*& first, const char* last, Time& time);

/// The line with commas between its fields and points in its numbers, and blanks for quotes. What
/// stands at a place of it stood there before.
std::string plain_csv(std::string_view line, Separator separator);

/// The fields of a line with points in its numbers, separated by commas or kRuns; blanks around a
/// field are trimmed. With Separator::kRuns no field is empty.
std::vector<std::string_view> split_fields(std::string_view line, Separator separator);

bool is_number(std::string_view text);

}  // namespace leeway
