/// @file
/// Messages of u-blox receivers. Private to the log readers.
/// Source: u-blox F9 HPG 1.32 Interface Description, UBX-22008968, section 3 "UBX protocol".
#pragma once

#include <cstdint>
#include <string_view>

#include "lib/logs/log_layout.hpp"
#include "lib/logs/messages/message_reader.hpp"

namespace leeway {

/// Class and number of a message, in the order of the bytes of the file.
enum class UbxKind : std::uint16_t {
  kNavStatus = 0x0301,
  kNavPvt = 0x0701,
  kNavHpPosLlh = 0x1401,
  kNavTimeGps = 0x2001,
  kEsfMeas = 0x0210,
  kEsfRaw = 0x0310,
};

UbxKind ubx_kind(std::string_view message);

/// What a message says: without sync, kind, length and checksum.
inline std::string_view ubx_payload(std::string_view message) {
  return message.substr(6, message.size() - 8);
}

/// The frame of bytes that may begin with a message. What is no UBX, as NMEA and RTCM in between,
/// is foreign; damage is that of messages of navigation and of sensors.
MessageFrame ubx_frame(std::string_view bytes, bool is_end);

/// Whether messages are in what the log begins with.
bool is_ubx(const LogOpening& log);

}  // namespace leeway
