#include "lib/logs/csv_header.hpp"

#include <algorithm>
#include <utility>

#include "leeway/earth/error.hpp"
#include "lib/logs/log_layout.hpp"

namespace leeway {

CsvHeader::CsvHeader(std::string_view line, std::string path) : path_(std::move(path)) {
  for (const std::string_view name : split_fields(line, Separator::kComma)) {
    names_.emplace_back(name);
  }
  columns_.resize(names_.size());
}

std::vector<std::string_view> CsvHeader::missing(std::span<const NamedColumn> wanted) const {
  std::vector<std::string_view> names;
  for (const NamedColumn& column : wanted) {
    if (std::find(names_.begin(), names_.end(), column.name) == names_.end()) {
      names.push_back(column.name);
    }
  }
  return names;
}

void CsvHeader::use(std::span<const NamedColumn> wanted) {
  for (const NamedColumn& column : wanted) {
    const auto found = std::find(names_.begin(), names_.end(), column.name);
    if (found == names_.end()) continue;
    if (std::find(found + 1, names_.end(), column.name) != names_.end()) {
      throw Error(path_ + ": column " + std::string(column.name) + " stands twice in the header");
    }
    columns_[static_cast<std::size_t>(found - names_.begin())] = column.column;
  }
}

void CsvHeader::require(std::span<const NamedColumn> wanted, const std::string& expected) {
  if (const auto names = missing(wanted); !names.empty()) {
    throw Error(path_ + ": missing columns " + join(names) + "; expected " + expected);
  }
  use(wanted);
}

bool CsvHeader::use_group(std::span<const NamedColumn> wanted) {
  const auto names = missing(wanted);
  if (names.size() == wanted.size()) return false;
  if (!names.empty()) {
    throw Error(path_ + ": missing columns " + join(names) + "; " + join(wanted) +
                " are used together: have all of them or none");
  }
  use(wanted);
  return true;
}

CsvHeader take_csv_header(LineReader& lines, std::span<const NamedColumn> wanted,
                          const std::string& expected) {
  CsvHeader header(first_line(lines, expected), lines.path());
  header.require(wanted, expected);
  lines.next();
  return header;
}

std::string join(std::span<const std::string_view> names) {
  std::string joined;
  for (const std::string_view name : names) {
    if (!joined.empty()) joined += ", ";
    joined += name;
  }
  return joined;
}

std::string join(std::span<const NamedColumn> columns) {
  std::vector<std::string_view> names;
  for (const NamedColumn& column : columns) names.push_back(column.name);
  return join(names);
}

}  // namespace leeway
