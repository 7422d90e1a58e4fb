/// @file
/// GPS time in messages of u-blox receivers. Private to the log readers.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "leeway/earth/time.hpp"
#include "lib/logs/log_layout.hpp"
#include "lib/logs/log_source.hpp"
#include "lib/logs/messages/ubx.hpp"

namespace leeway {

/// Whether what a log begins with has a message of a kind.
bool has_ubx_kind(const LogOpening& log, UbxKind kind);

/// Times of the week with the week that NAV-PVT and NAV-TIMEGPS tell. In a log without both, times
/// are those of the week, which go on over its end.
class UbxWeek {
 public:
  UbxWeek() = default;

  /// Says in the notes that a log has no week.
  explicit UbxWeek(LogOpening& log);

  /// What a message says of the week. @pre Its checksum is right.
  void learn(UbxKind kind, std::string_view payload);

  /// GPS time of a time of week; nothing as long as the week is not known.
  std::optional<Time> time_of(std::uint32_t time_of_week_ms);

  /// The same of a NAV-PVT, to the nanosecond where it has the time of day.
  std::optional<Time> time_of_pvt(std::string_view payload);

 private:
  bool has_week_{false};
  std::optional<Duration> week_start_{};
  std::uint32_t newest_ms_{0};
  WeekUnroller unroller_{};
};

}  // namespace leeway
