#include "leeway/logs/line_reader.hpp"

#include <cstring>

namespace leeway {
namespace {

// Of a line that is too long. An endless one would be skipped for ever.
constexpr std::size_t kMaxSkippedBytes = 64 * 1024 * 1024;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Where a newline stands in the text from a place on, or npos. It is memchr for all compilers.
std::size_t newline_in(std::string_view text, std::size_t from) {
  const void* const found = std::memchr(text.data() + from, '\n', text.size() - from);
  if (!found) return std::string_view::npos;
  return static_cast<std::size_t>(static_cast<const char*>(found) - text.data());
}

}  // namespace

LineReader::LineReader(const std::filesystem::path& path) : bytes_(path) {
  if (bytes_.view().starts_with(kByteOrderMark)) bytes_.take(kByteOrderMark.size());
}

std::optional<std::string_view> LineReader::next() {
  if (rest_to_skip_) skip_rest_of_line();
  if (is_endless_) return std::nullopt;
  overlong_ = false;
  std::size_t scanned = 0;
  do {
    const std::string_view text = bytes_.view();
    const std::size_t newline = newline_in(text, scanned);
    if (newline != std::string_view::npos) return take(newline, newline + 1);
    scanned = text.size();
    if (scanned > kMaxLineBytes) {
      rest_to_skip_ = true;
      return take(scanned, scanned);
    }
  } while (bytes_.refill());
  // A damaged stream cuts its last line anywhere: "-9.81" may end as "-9".
  if (bytes_.view().empty() || bytes_.is_damaged()) return std::nullopt;
  return take(scanned, scanned);
}

void LineReader::unread() {
  bytes_.give_back(taken_);
  rest_to_skip_ = false;
  --line_number_;
}

std::string_view LineReader::take(std::size_t line_size, std::size_t taken) {
  ++line_number_;
  std::string_view line = bytes_.view().substr(0, line_size);
  bytes_.take(taken);
  taken_ = taken;
  if (line.ends_with('\r')) line.remove_suffix(1);
  overlong_ = line.size() > kMaxLineBytes;
  return line.substr(0, kMaxLineBytes);
}

void LineReader::skip_rest_of_line() {
  rest_to_skip_ = false;
  std::size_t skipped = 0;
  do {
    const std::string_view text = bytes_.view();
    const std::size_t newline = newline_in(text, 0);
    if (newline != std::string_view::npos) return bytes_.take(newline + 1);
    skipped += text.size();
    bytes_.take(text.size());
    is_endless_ = skipped > kMaxSkippedBytes;
  } while (!is_endless_ && bytes_.refill());
}

std::string LineReader::damage() const {
  const std::string line = "line " + std::to_string(line_number_);
  if (!is_endless_) return bytes_.damage(line);
  return path() + ": " + line + " has no end within 64 MiB; the file is no text log from there on";
}

}  // namespace leeway
