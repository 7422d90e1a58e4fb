/// @file
/// Columns of a CSV log, found by name in its header. Private to the log readers.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/logs/line_reader.hpp"
#include "lib/logs/text_fields.hpp"

namespace leeway {

struct NamedColumn {
  std::string_view name;
  Column column;
};

class CsvHeader {
 public:
  CsvHeader(std::string_view line, std::string path);

  /// The names the header does not have.
  std::vector<std::string_view> missing(std::span<const NamedColumn> wanted) const;
  bool has(std::span<const NamedColumn> wanted) const { return missing(wanted).empty(); }

  /// Marks the columns for parser(). Those the header lacks are left out.
  /// @throws Error when a wanted name stands there twice.
  void use(std::span<const NamedColumn> wanted);

  /// As use(), but all of them must be there.
  /// @throws Error naming those that are not, and what was expected.
  void require(std::span<const NamedColumn> wanted, const std::string& expected);

  /// As use(), but the columns are there together or not at all: returns whether they are.
  /// @throws Error when only some of them are there.
  bool use_group(std::span<const NamedColumn> wanted);

  LineParser parser(Separator separator = Separator::kComma) const { return {separator, columns_}; }

 private:
  std::vector<std::string> names_;
  std::vector<Column> columns_;
  std::string path_;
};

/// The header that a log must begin with, its columns marked; the lines then go on behind it.
/// @throws Error when the log is empty or a column is missing, saying what was expected.
CsvHeader take_csv_header(LineReader& lines, std::span<const NamedColumn> wanted,
                          const std::string& expected);

/// "a, b, c".
std::string join(std::span<const std::string_view> names);
std::string join(std::span<const NamedColumn> columns);

}  // namespace leeway
