/// @file
/// Messages of a binary log, one after the other in constant memory. Private to the log readers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "leeway/logs/byte_reader.hpp"
#include "leeway/logs/log_summary.hpp"

namespace leeway {

/// What stands at the begin of bytes.
struct MessageFrame {
  enum class Kind {
    kMoreBytes,  ///< to be told with more of them
    kMessage,
    kForeign,  ///< of no message, and nobody's concern
    kDamage,
  };
  Kind kind{};
  std::size_t size{};   ///< > 0, unless more bytes are asked for
  LineDamage reason{};  ///< of damage
};

/// Tells the frame of bytes, of which there is one at least.
/// @param is_end  there are no more: kMoreBytes is no answer
using Framing = std::function<MessageFrame(std::string_view bytes, bool is_end)>;

/// Reader of a file message by message, without allocating for one.
class MessageReader {
 public:
  MessageReader(ByteReader bytes, Framing framing)
      : bytes_(std::move(bytes)), framing_(std::move(framing)) {}

  /// The next message, or bytes that are damaged(), or nothing at the end. The view lives until the
  /// next call.
  std::optional<std::string_view> next();

  /// Why what was just delivered is no message.
  std::optional<LineDamage> damaged() const { return damaged_; }

  /// Place of what was just delivered: in the file, or in what its gzip stream holds.
  std::int64_t offset() const { return offset_; }

  /// Empty, or why the file ended before its end.
  std::string damage() const;

  const std::string& path() const { return bytes_.path(); }

 private:
  ByteReader bytes_;
  Framing framing_;
  std::optional<LineDamage> damaged_{};
  std::int64_t offset_{0};
  std::size_t without_message_{0};  // bytes since the last one
  bool is_endless_{false};
};

}  // namespace leeway
