#include "leeway/logs/line_reader.hpp"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>

#include "leeway/earth/error.hpp"

namespace leeway {
namespace {

// One gzread decodes kChunkBytes straight into our buffer, because that is twice zlib's own; what a
// corrupt stream costs is one such chunk.
constexpr unsigned kZlibBufferBytes = 16 * 1024;
constexpr unsigned kChunkBytes = 2 * kZlibBufferBytes;
constexpr std::size_t kReadBufferBytes = 2 * LineReader::kMaxLineBytes;
// Of a line that is too long. An endless one would be skipped for ever.
constexpr std::size_t kMaxSkippedBytes = 64 * 1024 * 1024;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

}  // namespace

void LineReader::Close::operator()(gzFile_s* file) const { gzclose_r(file); }

LineReader::LineReader(const std::filesystem::path& path)
    : path_(path.string()), buffer_(kReadBufferBytes) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw Error(path_ + ": is a directory, not a file");
  }
  errno = 0;
  file_.reset(gzopen(path_.c_str(), "rb"));
  if (!file_) throw Error(path_ + ": cannot be opened: " + std::strerror(errno));
  gzbuffer(file_.get(), kZlibBufferBytes);
  refill();
  int code = Z_OK;
  gzerror(file_.get(), &code);
  if (code == Z_ERRNO) throw Error(damage_);
  if (std::string_view(buffer_.data(), end_).starts_with(kByteOrderMark)) {
    begin_ = kByteOrderMark.size();
  }
}

std::optional<std::string_view> LineReader::next() {
  if (rest_to_skip_) skip_rest_of_line();
  overlong_ = false;
  std::size_t scanned = 0;
  do {
    const char* const from = buffer_.data() + begin_ + scanned;
    if (const void* newline = std::memchr(from, '\n', end_ - begin_ - scanned)) {
      const auto at = static_cast<std::size_t>(static_cast<const char*>(newline) - buffer_.data());
      return take(at, at + 1);
    }
    scanned = end_ - begin_;
    if (scanned > kMaxLineBytes) {
      rest_to_skip_ = true;
      return take(end_, end_);
    }
  } while (refill());
  // A damaged stream cuts its last line anywhere: "-9.81" may end as "-9".
  if (begin_ == end_ || !damage_.empty()) return std::nullopt;
  return take(end_, end_);
}

void LineReader::unread() {
  begin_ = line_begin_;
  rest_to_skip_ = false;
  --line_number_;
}

std::string_view LineReader::take(std::size_t line_end, std::size_t next_begin) {
  ++line_number_;
  line_begin_ = begin_;
  begin_ = next_begin;
  std::string_view line(buffer_.data() + line_begin_, line_end - line_begin_);
  if (line.ends_with('\r')) line.remove_suffix(1);
  overlong_ = line.size() > kMaxLineBytes;
  return line.substr(0, kMaxLineBytes);
}

void LineReader::skip_rest_of_line() {
  rest_to_skip_ = false;
  std::size_t skipped = 0;
  do {
    if (const void* newline = std::memchr(buffer_.data() + begin_, '\n', end_ - begin_)) {
      begin_ = static_cast<std::size_t>(static_cast<const char*>(newline) - buffer_.data()) + 1;
      return;
    }
    skipped += end_ - begin_;
    begin_ = end_;
    if (skipped > kMaxSkippedBytes) {
      at_end_ = true;
      damage_ = path_ + ": line " + std::to_string(line_number_) +
                " has no end within 64 MiB; the file is no text log from there on";
      return;
    }
  } while (refill());
}

bool LineReader::refill() {
  if (at_end_) return false;
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t room = std::min<std::size_t>(kChunkBytes, buffer_.size() - end_);
  const int count = gzread(file_.get(), buffer_.data() + end_, static_cast<unsigned>(room));
  if (count > 0) {
    end_ += static_cast<std::size_t>(count);
    return true;
  }
  at_end_ = true;
  int code = Z_OK;
  const char* const text = gzerror(file_.get(), &code);
  if (code != Z_OK) damage_ = damage_message(code, text);
  return false;
}

std::string LineReader::damage_message(int code, const char* zlib_text) const {
  if (code == Z_ERRNO) return path_ + ": cannot be read: " + std::strerror(errno);
  const std::string after = " after line " + std::to_string(line_number_);
  if (code == Z_BUF_ERROR) {
    return path_ + ": gzip stream ends early" + after + "; the file is incomplete";
  }
  return path_ + ": gzip stream is corrupt" + after + " (" + zlib_text + ")";
}

}  // namespace leeway
