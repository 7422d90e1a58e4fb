/// @file
/// Text written through a buffer. A half-written file is never left under the final name.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/earth/time.hpp"

struct gzFile_s;  // zlib's, kept out of this header

namespace leeway {

constexpr std::size_t kMaxNumberBytes = 32;  ///< the longest shortest double has 24

/// Writes a time in seconds to the nanosecond. @returns the place after it
char* put_time(char* out, Time time);

/// Writes a number with so many decimals, or with those of CsvColumn. @returns the place after it
char* put_number(char* out, double value, int decimals);

/// A text file, gzip when the name ends in .gz. It writes `path`.partial and renames it to `path`
/// on close(); destroyed without close() it leaves neither.
class TextFile {
 public:
  /// @throws Error when the file cannot be created.
  explicit TextFile(const std::filesystem::path& path);
  ~TextFile();
  TextFile(TextFile&&) noexcept;
  TextFile& operator=(TextFile&&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// Room for so many characters, at most 64 Ki, that end() takes over as far as they are used.
  /// @throws Error after close() and on a write failure.
  char* begin(std::size_t bytes);
  void end(const char* end) { used_ = static_cast<std::size_t>(end - buffer_.data()); }

  /// Short text. @throws Error as begin() does.
  void put(std::string_view text) { end(std::copy(text.begin(), text.end(), begin(text.size()))); }

  /// Finishes the file. @throws Error when it cannot be written completely.
  void close();

 private:
  struct Close {
    void operator()(gzFile_s* file) const;
  };

  void flush();
  [[noreturn]] void fail(const std::string& doing, int error) const;

  std::filesystem::path path_;
  std::filesystem::path partial_;
  std::unique_ptr<gzFile_s, Close> file_;
  std::vector<char> buffer_;
  std::size_t used_{0};
};

}  // namespace leeway
