/// @file
/// Lines of a text file, plain or gzip, one after the other in constant memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "leeway/logs/byte_reader.hpp"

namespace leeway {

/// Reader of a file line by line, without allocating for a line. A UTF-8 byte order mark is
/// skipped.
class LineReader {
 public:
  /// Longer lines are no text log: see overlong().
  static constexpr std::size_t kMaxLineBytes = 64 * 1024;

  /// @throws Error when the file is missing, unreadable or a directory.
  explicit LineReader(const std::filesystem::path& path);

  /// The next line without its "\n" or "\r\n", or nothing at the end. The view lives until the next
  /// call. A last line without a newline is delivered, unless the file is damaged there.
  std::optional<std::string_view> next();

  /// Makes next() deliver the line it just delivered again. @pre next() delivered one.
  void unread();

  /// Text that next() has yet to deliver, as much as was read: some KiB unless the file is shorter.
  std::string_view preview() const { return bytes_.view(); }

  /// The file, from what next() has yet to deliver on.
  ByteReader&& take_bytes() && { return std::move(bytes_); }

  /// Whether the line just delivered was longer than kMaxLineBytes: its rest is skipped.
  bool overlong() const { return overlong_; }

  /// Number of the line just delivered, from 1; 0 before the first.
  std::int64_t line_number() const { return line_number_; }

  /// Empty, or why the file ended before its end: ByteReader::damage(), or a line without an end.
  std::string damage() const;

  const std::string& path() const { return bytes_.path(); }

 private:
  void skip_rest_of_line();
  std::string_view take(std::size_t line_size, std::size_t taken);

  ByteReader bytes_;
  std::size_t taken_{0};  // with the line just delivered
  std::int64_t line_number_{0};
  bool overlong_{false};
  bool rest_to_skip_{false};
  bool is_endless_{false};
};

}  // namespace leeway
