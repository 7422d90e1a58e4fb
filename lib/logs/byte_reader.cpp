#include "leeway/logs/byte_reader.hpp"

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

}  // namespace

void ByteReader::Close::operator()(gzFile_s* file) const { gzclose_r(file); }

ByteReader::ByteReader(const std::filesystem::path& path)
    : path_(path.string()), buffer_(kBufferBytes) {
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
  if (code == Z_ERRNO) throw Error(damage({}));
}

bool ByteReader::refill() {
  if (at_end_ || end_ - begin_ == buffer_.size()) return false;
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  const std::size_t room = std::min<std::size_t>(kChunkBytes, buffer_.size() - end_);
  const int count = gzread(file_.get(), buffer_.data() + end_, static_cast<unsigned>(room));
  if (count > 0) {
    end_ += static_cast<std::size_t>(count);
    read_ += count;
    return true;
  }
  at_end_ = true;
  note_damage();
  return false;
}

void ByteReader::note_damage() {
  int code = Z_OK;
  const char* const text = gzerror(file_.get(), &code);
  if (code == Z_OK) return;
  if (code == Z_ERRNO) {
    damage_ = std::string("cannot be read: ") + std::strerror(errno);
  } else if (code == Z_BUF_ERROR) {
    damage_ = "gzip stream ends early";
    remedy_ = "; the file is incomplete";
  } else {
    damage_ = "gzip stream is corrupt";
    remedy_ = std::string(" (") + text + ")";
  }
}

std::string ByteReader::damage(const std::string& after) const {
  if (damage_.empty()) return {};
  const std::string place = after.empty() || remedy_.empty() ? "" : " after " + after;
  return path_ + ": " + damage_ + place + remedy_;
}

}  // namespace leeway
