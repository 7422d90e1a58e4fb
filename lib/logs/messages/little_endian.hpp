/// @file
/// Numbers in the bytes of a message. Private to the log readers.
#pragma once

#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace leeway {

static_assert(std::endian::native == std::endian::little,
              "messages are little-endian; on another machine turn their bytes around here");

/// A number at a place of little-endian bytes. @pre at + sizeof(T) <= bytes.size().
template <class T>
T number_at(std::string_view bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace leeway
