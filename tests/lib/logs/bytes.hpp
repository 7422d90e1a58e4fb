/// @file
/// Messages of binary logs as their recorders write them.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace leeway::test {

/// Numbers one behind the other, little-endian.
class Bytes {
 public:
  template <class T>
  Bytes& add(T value) {
    static_assert(std::endian::native == std::endian::little);
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    text_.append(bytes, sizeof value);
    return *this;
  }
  Bytes& add_text(std::string_view text) {
    text_ += text;
    return *this;
  }
  Bytes& add_zeros(std::size_t count) {
    text_.append(count, '\0');
    return *this;
  }

  /// Overwrites a number. @pre There are bytes at that place.
  template <class T>
  Bytes& set(std::size_t at, T value) {
    std::memcpy(text_.data() + at, &value, sizeof value);
    return *this;
  }

  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// A UBX message: sync, class, number, length, payload, and Fletcher's checksum.
inline std::string ubx_message(std::uint8_t group, std::uint8_t number, std::string_view payload) {
  Bytes message;
  message.add(group).add(number).add(static_cast<std::uint16_t>(payload.size()));
  message.add_text(payload);
  std::uint8_t a = 0, b = 0;
  for (const char c : message.text()) {
    a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(c));
    b = static_cast<std::uint8_t>(b + a);
  }
  message.add(a).add(b);
  return "\xB5\x62" + message.text();
}

}  // namespace leeway::test
