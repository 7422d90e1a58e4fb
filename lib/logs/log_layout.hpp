/// @file
/// Layouts of a log: how one is told, and read. Private to the log readers.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/earth/error.hpp"
#include "leeway/earth/names.hpp"
#include "leeway/logs/line_reader.hpp"
#include "leeway/logs/log_format.hpp"
#include "lib/logs/messages/message_reader.hpp"
#include "lib/logs/text_fields.hpp"

namespace leeway {

/// What a log begins with, by which its layout is told.
struct LogHead {
  std::vector<std::string> comments{};  ///< lines before the first that carries something
  std::string line{};                   ///< that one; empty in a log without any
  bool is_binary{false};                ///< it is no line of text
  std::string_view bytes{};             ///< from there on, some KiB; until the lines go on
};

/// The head of a log; next() then delivers its line again.
LogHead read_head(LineReader& lines);

/// The line of the head, for layouts that must have one.
/// @throws Error when there is none, saying what was expected.
std::string first_line(LineReader& lines, const std::string& expected);

/// A number first, and no comma: no CSV, and no header.
bool is_bare_numbers(std::string_view line);

/// A log that is being opened: the lines stand before the head's line.
struct LogOpening {
  LogHead head;
  LineReader& lines;
  const LogFormat& format;
  std::vector<std::string>& notes;  ///< for the summary
  Framing framing{};                ///< told by a layout of messages: it has no lines
};

/// One layout of a kind of log: a row of the table of its reader.
template <class Row>
struct LogLayout {
  std::string_view name{};  ///< for users: "KF-GINS text"
  std::string expected{};   ///< what such a log has, for error messages
  bool (*sniff)(const LogOpening& log){};
  /// Leaves the lines at the first row; or tells the framing of messages, which the parser then
  /// gets. @throws Error when the log lacks what the layout must have.
  RowParser<Row> (*parser)(LogOpening& log){};
  bool is_binary{false};
};

/// The layout that the format names, or the last of the table that recognizes the head: the first
/// of them must take any text.
/// @throws Error when the table has none of that name, or none for a binary file.
template <class Row>
const LogLayout<Row>& layout_of(const LogOpening& log, const std::vector<LogLayout<Row>>& layouts) {
  const std::string& wanted = log.format.layout;
  const auto found = std::find_if(layouts.rbegin(), layouts.rend(), [&](const auto& layout) {
    if (!wanted.empty()) return is_same_name(layout.name, wanted);
    return (layout.is_binary || !log.head.is_binary) && layout.sniff(log);
  });
  if (found != layouts.rend()) return *found;
  std::string known;
  for (const auto& layout : layouts)
    known += (known.empty() ? "" : ", ") + std::string(layout.name);
  throw Error(log.lines.path() +
              (wanted.empty()
                   ? ": is a binary file of no layout that is read; convert it to CSV by "
                     "the recorder's tools. There are: "
                   : ": no layout is named '" + wanted + "'; there are: ") +
              known);
}

/// "a, b, or c".
template <class Row>
std::string list_of(const std::vector<LogLayout<Row>>& layouts) {
  std::string list = layouts.front().expected;
  for (std::size_t k = 1; k < layouts.size(); ++k) {
    list += (k + 1 == layouts.size() ? ", or " : ", ") + layouts[k].expected;
  }
  return list;
}

}  // namespace leeway
