#include "lib/logs/messages/ulog.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include "lib/logs/messages/little_endian.hpp"

namespace leeway {
namespace {

constexpr std::string_view kUlogMagic = "ULog\x01\x12\x35";
constexpr std::string_view kUlogSync = "\x2F\x73\x13\x20\x25\x0C\xBB\x12";
constexpr std::size_t kUlogFileHeadBytes = 16;
constexpr std::size_t kUlogHeadBytes = 3;   // length, type
constexpr std::size_t kUlogLookAhead = 11;  // what is_plausible() looks at
constexpr int kUlogChain = 3;               // messages in a row are no chance
constexpr std::uint16_t kMostUlogIds = 1024;
constexpr std::uint8_t kMostUlogInstances = 16;

bool is_printable(char c) { return c >= ' ' && c <= '~'; }

/// Whether what stands behind a message's head fits its type. Of a random head one in 1e4 does.
bool is_plausible_content(char type, std::string_view content, std::size_t size) {
  if (content.size() < std::min(size, kUlogLookAhead - kUlogHeadBytes)) return false;
  const auto id_at = [&](std::size_t at) { return number_at<std::uint16_t>(content, at); };
  switch (type) {
    case 'D':
      return size > 2 && id_at(0) < kMostUlogIds;
    case 'A':
      return size > 3 && static_cast<std::uint8_t>(content[0]) < kMostUlogInstances &&
             id_at(1) < kMostUlogIds && is_printable(content[3]);
    case 'R':
      return size == 2 && id_at(0) < kMostUlogIds;
    case 'S':
      return size == kUlogSync.size() && content.starts_with(kUlogSync);
    case 'O':
      return size == 2;
    case 'B':
      return size == 40;
    case 'F':
      return size > 2 && is_printable(content[0]) && is_printable(content[1]);
    case 'L':
      return size > 9 && content[0] >= '0' && content[0] <= '7';
    case 'C':
      return size > 11 && content[0] >= '0' && content[0] <= '7';
    case 'I':
    case 'P':
      return size > 2 && static_cast<std::uint8_t>(content[0]) < size && is_printable(content[1]);
    case 'M':
    case 'Q':
      return size > 3 && static_cast<std::uint8_t>(content[1]) < size && is_printable(content[2]);
    default:
      return false;
  }
}

/// Bytes of the message that seems to stand at the begin; nothing where none does.
std::optional<std::size_t> plausible_size(std::string_view bytes) {
  if (bytes.starts_with(kUlogMagic)) return kUlogFileHeadBytes;
  if (bytes.size() < kUlogHeadBytes) return std::nullopt;
  const std::size_t size = number_at<std::uint16_t>(bytes, 0);
  if (!is_plausible_content(bytes[2], bytes.substr(kUlogHeadBytes), size)) return std::nullopt;
  return kUlogHeadBytes + size;
}

/// Whether messages follow one another, as far as there are bytes.
bool is_chain(std::string_view bytes) {
  for (int k = 0; k < kUlogChain; ++k) {
    const auto size = plausible_size(bytes);
    if (!size) return false;
    if (*size + kUlogLookAhead > bytes.size()) return k > 0 || *size == bytes.size();
    bytes.remove_prefix(*size);
  }
  return true;
}

/// Where the next message stands behind the first byte, or the end of the bytes.
std::size_t next_chain(std::string_view bytes) {
  for (std::size_t at = 1; at + kUlogLookAhead <= bytes.size(); ++at) {
    if (is_chain(bytes.substr(at))) return at;
  }
  return bytes.size();
}

/// The types of numbers, a letter each, in the order of names and sizes.
constexpr std::string_view kUlogTypes = "bBhHiIqQfd?c";
constexpr std::array<std::string_view, 12> kUlogTypeNames{
    "int8_t",  "uint8_t",  "int16_t", "uint16_t", "int32_t", "uint32_t",
    "int64_t", "uint64_t", "float",   "double",   "bool",    "char"};
constexpr std::array<std::size_t, 12> kUlogTypeBytes{1, 1, 2, 2, 4, 4, 8, 8, 4, 8, 1, 1};

double ulog_number(std::string_view message, char type, std::size_t at) {
  switch (type) {
    case 'b':
      return number_at<std::int8_t>(message, at);
    case 'h':
      return number_at<std::int16_t>(message, at);
    case 'H':
      return number_at<std::uint16_t>(message, at);
    case 'i':
      return number_at<std::int32_t>(message, at);
    case 'I':
      return number_at<std::uint32_t>(message, at);
    case 'q':
      return static_cast<double>(number_at<std::int64_t>(message, at));
    case 'Q':
      return static_cast<double>(number_at<std::uint64_t>(message, at));
    case 'f':
      return number_at<float>(message, at);
    case 'd':
      return number_at<double>(message, at);
    case 0:
      return std::numeric_limits<double>::quiet_NaN();
    default:
      return number_at<std::uint8_t>(message, at);
  }
}

}  // namespace

bool is_ulog_head(std::string_view message) { return message.starts_with(kUlogMagic); }

bool is_ulog(const LogOpening& log) { return is_ulog_head(log.head.bytes); }

MessageFrame ulog_frame(std::string_view bytes, bool is_end) {
  if (bytes.size() < kUlogFileHeadBytes && !is_end) return {};
  const auto size = plausible_size(bytes);
  if (size) {
    if (bytes.size() < *size + kUlogLookAhead && !is_end) return {};
    if (bytes.size() == *size) return {MessageFrame::Kind::kMessage, *size};
    const bool is_whole = bytes.size() > *size;
    if (is_whole && plausible_size(bytes.substr(*size)))
      return {MessageFrame::Kind::kMessage, *size};
    // What is damaged is the length, if messages go on within; else it is what follows.
    if (is_whole && next_chain(bytes) >= *size) return {MessageFrame::Kind::kMessage, *size};
  }
  const std::size_t next = next_chain(bytes);
  const bool is_found = next < bytes.size();
  if (!is_found && !is_end) {
    if (bytes.size() < ByteReader::kBufferBytes / 2) return {};
    return {MessageFrame::Kind::kDamage, bytes.size() - kUlogLookAhead, LineDamage::kLost};
  }
  return {MessageFrame::Kind::kDamage, next,
          size && !is_found ? LineDamage::kCutShort : LineDamage::kLost};
}

void UlogTopic::learn(std::string_view message) {
  const std::string_view content = message.substr(kUlogHeadBytes);
  if (message[2] == 'F') {
    const bool is_ours =
        content.starts_with(name_) && content.substr(name_.size()).starts_with(':');
    if (is_ours) learn_format(content.substr(name_.size() + 1));
  } else if (message[2] == 'A' && content[0] == 0 && content.substr(3) == name_) {
    id_ = number_at<std::uint16_t>(content, 1);
  }
}

void UlogTopic::learn_format(std::string_view format) {
  places_.assign(wanted_.size(), Place{});
  std::size_t at = kUlogHeadBytes + sizeof(std::uint16_t);
  least_bytes_ = at;
  while (!format.empty()) {
    const std::string_view field = format.substr(0, format.find(';'));
    format.remove_prefix(std::min(field.size() + 1, format.size()));
    const std::size_t blank = std::min(field.find(' '), field.size());
    const std::string_view type = field.substr(0, std::min(blank, field.find('[')));
    const auto known = std::find(kUlogTypeNames.begin(), kUlogTypeNames.end(), type);
    if (known == kUlogTypeNames.end() || blank == field.size()) return;
    const auto index = static_cast<std::size_t>(known - kUlogTypeNames.begin());
    std::uint16_t count = 1;
    if (type.size() < blank) {
      std::from_chars(field.data() + type.size() + 1, field.data() + blank, count);
    }
    for (std::size_t k = 0; k < wanted_.size(); ++k) {
      const bool is_wanted =
          wanted_[k].field == field.substr(blank + 1) && wanted_[k].element < count;
      if (!is_wanted) continue;
      places_[k] = {kUlogTypes[index], at + wanted_[k].element * kUlogTypeBytes[index]};
      least_bytes_ = std::max(least_bytes_, places_[k].at + kUlogTypeBytes[index]);
    }
    at += count * kUlogTypeBytes[index];
  }
}

bool UlogTopic::is_of(std::string_view message) const {
  return id_ && message[2] == 'D' && number_at<std::uint16_t>(message, kUlogHeadBytes) == *id_;
}

bool UlogTopic::read(std::string_view message, std::span<double> values) const {
  if (message.size() < least_bytes_) return false;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    values[k] = ulog_number(message, places_[k].type, places_[k].at);
  }
  return true;
}

}  // namespace leeway
