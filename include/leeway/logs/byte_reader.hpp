/// @file
/// Bytes of a file, plain or gzip, one after the other in constant memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct gzFile_s;  // zlib's, kept out of this header

namespace leeway {

/// Reader of a file through a buffer. Whether the file is gzip is told from its first bytes, not
/// from its name.
class ByteReader {
 public:
  static constexpr std::size_t kBufferBytes = 128 * 1024;

  /// @throws Error when the file is missing, unreadable or a directory.
  explicit ByteReader(const std::filesystem::path& path);

  /// Bytes that were read and not yet taken; they live until the next refill().
  std::string_view view() const { return {buffer_.data() + begin_, end_ - begin_}; }

  /// Puts bytes at the begin of the view behind us. @pre count <= view().size().
  void take(std::size_t count) { begin_ += count; }

  /// Takes the last ones back. @pre They were taken after the last refill().
  void give_back(std::size_t count) { begin_ -= count; }

  /// Adds bytes to the view: false at the end of the file, of what of it can be read, or when
  /// kBufferBytes are in view.
  bool refill();

  /// Place of the view's begin in the file, or in what its gzip stream holds.
  std::int64_t offset() const { return read_ - static_cast<std::int64_t>(end_ - begin_); }

  /// Whether the file ended before its end: a cut or corrupt gzip stream, an I/O error. Of a
  /// corrupt stream up to 32 KiB of good bytes before the damage may be lost.
  bool is_damaged() const { return !damage_.empty(); }

  /// Why it did, or empty. @param after  where it was, as "line 7"
  std::string damage(const std::string& after) const;

  const std::string& path() const { return path_; }

 private:
  struct Close {
    void operator()(gzFile_s* file) const;
  };

  void note_damage();

  std::string path_;
  std::unique_ptr<gzFile_s, Close> file_;
  std::vector<char> buffer_;
  std::size_t begin_{0};
  std::size_t end_{0};
  std::int64_t read_{0};
  bool at_end_{false};
  std::string damage_;  // before the place
  std::string remedy_;  // behind it
};

}  // namespace leeway
