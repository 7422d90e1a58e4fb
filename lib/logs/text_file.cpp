#include "lib/logs/text_file.hpp"

#include <zlib.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

#include "leeway/earth/error.hpp"
#include "leeway/logs/csv_writer.hpp"

namespace leeway {
namespace {

constexpr std::size_t kWriteBufferBytes = 128 * 1024;
constexpr double kMaxScaled = 9e18;  // fits a signed 64-bit integer
constexpr std::uint64_t kNsPerS = 1'000'000'000;

constexpr std::uint64_t power_of_ten(int exponent) {
  return exponent == 0 ? 1 : 10 * power_of_ten(exponent - 1);
}

// The digits of `scaled` with a decimal point before the last `decimals` of them.
char* put_scaled(char* out, bool negative, std::uint64_t scaled, int decimals) {
  if (negative) *out++ = '-';
  const std::uint64_t unit = power_of_ten(decimals);
  out = std::to_chars(out, out + kMaxNumberBytes, scaled / unit).ptr;
  if (decimals == 0) return out;
  *out++ = '.';
  std::uint64_t rest = scaled % unit;
  for (char* digit = out + decimals; digit != out; rest /= 10) {
    *--digit = static_cast<char>('0' + rest % 10);
  }
  return out + decimals;
}

}  // namespace

char* put_time(char* out, Time time) {
  const auto ns = time.time_since_epoch().count();
  const auto magnitude = ns < 0 ? -static_cast<std::uint64_t>(ns) : static_cast<std::uint64_t>(ns);
  if (magnitude % kNsPerS == 0) return put_scaled(out, ns < 0, magnitude / kNsPerS, 0);
  out = put_scaled(out, ns < 0, magnitude, 9);
  while (out[-1] == '0') --out;
  return out;
}

char* put_number(char* out, double value, int decimals) {
  if (decimals >= 0) {
    const double scaled = std::abs(value) * static_cast<double>(power_of_ten(decimals));
    if (scaled < kMaxScaled) {
      const auto rounded = static_cast<std::uint64_t>(std::llround(scaled));
      return put_scaled(out, value < 0.0 && rounded != 0, rounded, decimals);
    }
  }
  char* const end = out + kMaxNumberBytes;
  if (decimals == CsvColumn::kSingle) return std::to_chars(out, end, static_cast<float>(value)).ptr;
  return std::to_chars(out, end, value).ptr;
}

void TextFile::Close::operator()(gzFile_s* file) const { gzclose_w(file); }

TextFile::TextFile(const std::filesystem::path& path)
    : path_(path), partial_(path), buffer_(kWriteBufferBytes) {
  partial_ += ".partial";
  const bool compressed = path.extension() == ".gz";
  errno = 0;
  file_.reset(gzopen(partial_.c_str(), compressed ? "wb" : "wbT"));  // T: no compression at all
  if (!file_) fail("cannot be created", errno);
}

TextFile::TextFile(TextFile&&) noexcept = default;

TextFile::~TextFile() {
  if (!file_) return;
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

char* TextFile::begin(std::size_t bytes) {
  if (!file_) throw Error(path_.string() + ": written to after close()");
  if (buffer_.size() - used_ < bytes) flush();
  return buffer_.data() + used_;
}

void TextFile::flush() {
  errno = 0;
  const int written = gzwrite(file_.get(), buffer_.data(), static_cast<unsigned>(used_));
  if (written != static_cast<int>(used_)) fail("cannot be written", errno);
  used_ = 0;
}

void TextFile::close() {
  if (!file_) return;
  if (used_ > 0) flush();
  errno = 0;
  if (gzclose_w(file_.release()) != Z_OK) {
    const int error = errno;
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
    fail("cannot be written", error);
  }
  std::error_code error;
  std::filesystem::rename(partial_, path_, error);
  if (error) {
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
    fail("cannot be renamed from " + partial_.string(), error.value());
  }
}

void TextFile::fail(const std::string& doing, int error) const {
  throw Error(path_.string() + ": " + doing +
              (error != 0 ? std::string(": ") + std::strerror(error) : ""));
}

}  // namespace leeway
