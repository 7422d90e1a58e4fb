/// @file
/// Messages of PX4's flight logs. Private to the log readers.
/// Source: PX4 User Guide, "ULog File Format".
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lib/logs/log_layout.hpp"
#include "lib/logs/messages/message_reader.hpp"

namespace leeway {

/// Later times are damaged: the library's end at 9.2e9 s.
inline constexpr double kMostUlogUs = 9e15;

/// The frame of bytes that may begin with a message, or with the head of a log. Messages have no
/// checksum: what shows damage is that no message follows. The search goes on within the message
/// whose length was wrong.
MessageFrame ulog_frame(std::string_view bytes, bool is_end);

/// Whether it is the head that every log begins with.
bool is_ulog_head(std::string_view message);

/// Whether a log begins with that head.
bool is_ulog(const LogOpening& log);

/// A number of a topic's messages: an element of an array, or the only one.
struct UlogNumber {
  std::string_view field{};
  std::size_t element{0};
};

/// Numbers of the messages of one topic, wherever the log's own definitions put them.
class UlogTopic {
 public:
  /// @param wanted  outlives the topic
  UlogTopic(std::string_view name, std::span<const UlogNumber> wanted)
      : name_(name), wanted_(wanted), places_(wanted.size()) {}

  /// What a definition says of the topic. Of its instances the first is read.
  void learn(std::string_view message);

  /// Whether its messages were announced.
  bool is_logged() const { return id_.has_value(); }

  /// Whether a message has its data.
  bool is_of(std::string_view message) const;

  /// The numbers wanted, in their order; NaN is what the log does not have.
  /// @returns false when the message is shorter than its definition.
  /// @pre is_of(message), values.size() == number of those wanted.
  bool read(std::string_view message, std::span<double> values) const;

 private:
  struct Place {
    char type{};  ///< of kUlogTypes; 0: not in the log
    std::size_t at{};
  };

  void learn_format(std::string_view format);

  std::string_view name_;
  std::span<const UlogNumber> wanted_;
  std::vector<Place> places_;
  std::size_t least_bytes_{0};  // of a message
  std::optional<std::uint16_t> id_{};
};

}  // namespace leeway
