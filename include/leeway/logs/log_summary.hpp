/// @file
/// What a log reader met on its way: lines, records, and every damaged line by its reason.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "leeway/earth/names.hpp"

namespace leeway {

/// Reasons for which a line, or a message of a binary log, is not used.
enum class LineDamage {
  kNotANumber,
  kMissingField,
  kNotFinite,
  kTimeGoesBack,
  kDuplicateTime,
  kTimeJumpsAhead,  ///< of the lines after it, which go on from before the jump
  kOutOfRange,
  kTooLong,   ///< LineReader::kMaxLineBytes
  kChecksum,  ///< missing, or not that of the record
  kCutShort,  ///< a message without its end
  kLost,      ///< bytes of no message, where one must be
};
constexpr auto names(LineDamage) {
  return std::array{
      "not a number",   "missing field",      "not finite",
      "time goes back", "time repeated",      "time jumps ahead of the lines after it",
      "out of range",   "line too long",      "checksum does not match",
      "cut short",      "bytes of no message"};
}
inline constexpr std::size_t kLineDamageCount = kAll<LineDamage>.size();

/// Counts of a log's lines and records, and its damaged lines by reason. A damaged line costs that
/// line, not the log.
struct LogSummary {
  static constexpr std::size_t kMaxMessages = 10;

  std::int64_t lines{0};    ///< that carry data: no header, comments, blank lines; or messages
  std::int64_t records{0};  ///< delivered
  /// Lines whose time repeats that of the line before. What they hold, an increment, happened: it
  /// was added to the next record.
  std::int64_t carried_over{0};
  std::array<std::int64_t, kLineDamageCount> damaged{};  ///< indexed by LineDamage
  std::vector<std::string> notes{};     ///< on the whole log: columns not used, units guessed
  std::vector<std::string> messages{};  ///< of the first damaged lines: path:line:column: reason
  std::string incomplete{};             ///< empty, or why the file ended early (LineReader::damage)

  std::int64_t count(LineDamage reason) const { return damaged[static_cast<std::size_t>(reason)]; }
  std::int64_t damaged_lines() const;
  bool clean() const { return damaged_lines() == 0 && incomplete.empty(); }

  void add_damage(LineDamage reason, std::string message);
};

}  // namespace leeway
