#include "lib/logs/messages/message_reader.hpp"

namespace leeway {
namespace {

// More bytes without a message than lie in any log. Endless ones would be searched for ever.
constexpr std::size_t kMaxBytesWithoutMessage = 64 * 1024 * 1024;

}  // namespace

std::optional<std::string_view> MessageReader::next() {
  bool is_end = false;
  while (!is_endless_) {
    const std::string_view bytes = bytes_.view();
    MessageFrame frame;
    if (!bytes.empty()) frame = framing_(bytes, is_end);
    if (frame.kind == MessageFrame::Kind::kMoreBytes) {
      if (bytes_.refill()) continue;
      if (is_end || bytes_.view().empty()) return std::nullopt;
      is_end = true;
      continue;
    }
    offset_ = bytes_.offset();
    bytes_.take(frame.size);
    without_message_ =
        frame.kind == MessageFrame::Kind::kMessage ? 0 : without_message_ + frame.size;
    is_endless_ = without_message_ > kMaxBytesWithoutMessage;
    damaged_.reset();
    if (frame.kind == MessageFrame::Kind::kDamage) damaged_ = frame.reason;
    if (frame.kind != MessageFrame::Kind::kForeign) return bytes.substr(0, frame.size);
  }
  return std::nullopt;
}

std::string MessageReader::damage() const {
  const std::string place = "byte " + std::to_string(offset_);
  if (!is_endless_) return bytes_.damage(place);
  return path() + ": no message within 64 MiB before " + place +
         "; the file is no log from there on";
}

}  // namespace leeway
