#include "lib/logs/messages/ubx.hpp"

#include <algorithm>
#include <cstddef>

#include "lib/logs/messages/little_endian.hpp"

namespace leeway {
namespace {

constexpr std::string_view kUbxSync = "\xB5\x62";
constexpr std::size_t kUbxHeadBytes = 6;  // sync, class, number, length
constexpr std::size_t kUbxFrameBytes = kUbxHeadBytes + 2;
constexpr char kUbxNavigation = 0x01, kUbxSensors = 0x10;

/// Fletcher's checksum of all between sync and checksum, with sums of a byte.
bool has_ubx_checksum(std::string_view message) {
  std::uint32_t a = 0, b = 0;
  for (const char c : message.substr(2, message.size() - 4)) {
    a += static_cast<unsigned char>(c);
    b += a;
  }
  return number_at<std::uint8_t>(message, message.size() - 2) == (a & 0xFF) &&
         number_at<std::uint8_t>(message, message.size() - 1) == (b & 0xFF);
}

}  // namespace

UbxKind ubx_kind(std::string_view message) { return UbxKind{number_at<std::uint16_t>(message, 2)}; }

MessageFrame ubx_frame(std::string_view bytes, bool is_end) {
  const std::size_t sync = std::min(bytes.find(kUbxSync), bytes.size());
  if (sync == bytes.size() && bytes.back() == kUbxSync[0] && !is_end) {
    return bytes.size() == 1 ? MessageFrame{}
                             : MessageFrame{MessageFrame::Kind::kForeign, bytes.size() - 1};
  }
  if (sync > 0) return {MessageFrame::Kind::kForeign, sync};
  const MessageFrame more =
      is_end ? MessageFrame{MessageFrame::Kind::kForeign, kUbxSync.size()} : MessageFrame{};
  if (bytes.size() < kUbxHeadBytes) return more;
  const std::size_t size = kUbxFrameBytes + number_at<std::uint16_t>(bytes, 4);
  const bool is_whole = bytes.size() >= size;
  if (!is_whole && !is_end) return more;
  if (is_whole && has_ubx_checksum(bytes.substr(0, size)))
    return {MessageFrame::Kind::kMessage, size};
  // The length may be what is damaged: the next message is searched for behind the sync.
  const bool is_ours = bytes[2] == kUbxNavigation || bytes[2] == kUbxSensors;
  return {is_ours ? MessageFrame::Kind::kDamage : MessageFrame::Kind::kForeign, kUbxSync.size(),
          is_whole ? LineDamage::kChecksum : LineDamage::kCutShort};
}

bool is_ubx(const LogOpening& log) {
  std::string_view bytes = log.head.bytes;
  while (!bytes.empty()) {
    const MessageFrame frame = ubx_frame(bytes, true);
    if (frame.kind == MessageFrame::Kind::kMessage) return true;
    bytes.remove_prefix(frame.size);
  }
  return false;
}

}  // namespace leeway
