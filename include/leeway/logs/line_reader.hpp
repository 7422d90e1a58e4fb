/// @file
/// Lines of a text file, plain or gzip, one after the other in constant memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct gzFile_s;  // zlib's, kept out of this header

namespace leeway {

/// Reader of a file line by line, without allocating for a line. Whether the file is gzip is told
/// from its first bytes, not from its name. A UTF-8 byte order mark is skipped.
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
  std::string_view preview() const { return {buffer_.data() + begin_, end_ - begin_}; }

  /// Whether the line just delivered was longer than kMaxLineBytes: its rest is skipped.
  bool overlong() const { return overlong_; }

  /// Number of the line just delivered, from 1; 0 before the first.
  std::int64_t line_number() const { return line_number_; }

  /// Empty, or why the file ended before its end (a cut or corrupt gzip stream, an I/O error). Of a
  /// corrupt stream up to 32 KiB of good text before the damage may be lost.
  const std::string& damage() const { return damage_; }

  const std::string& path() const { return path_; }

 private:
  struct Close {
    void operator()(gzFile_s* file) const;
  };

  bool refill();
  void skip_rest_of_line();
  std::string_view take(std::size_t line_end, std::size_t next_begin);
  std::string damage_message(int code, const char* zlib_text) const;

  std::string path_;
  std::unique_ptr<gzFile_s, Close> file_;
  std::vector<char> buffer_;
  std::size_t line_begin_{0};
  std::size_t begin_{0};  // of the text not yet delivered
  std::size_t end_{0};
  std::int64_t line_number_{0};
  bool at_end_{false};
  bool overlong_{false};
  bool rest_to_skip_{false};
  std::string damage_;
};

}  // namespace leeway
