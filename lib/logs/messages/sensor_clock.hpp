/// @file
/// A sensor's own clock as GPS time, by the order in which messages come. Private to the log
/// readers.
#pragma once

#include <cstdint>
#include <optional>

#include "leeway/earth/time.hpp"

namespace leeway {

/// Counts of a clock that starts again at 2^24 or 2^32, counted on.
class CountUnroller {
 public:
  std::int64_t unroll(std::uint32_t count);

 private:
  std::optional<std::uint32_t> last_{};
  std::int64_t offset_{0};
};

/// GPS time of a clock that runs evenly: the line through the epochs of the receiver against the
/// newest sample before each, by least squares with a fading memory of 64 epochs. Times are early
/// by what a receiver takes from an epoch to its message, some 0.05 s.
class SensorClock {
 public:
  /// An epoch, told behind the sample that the clock stamped with `newest`.
  void learn(Time epoch, Time newest);

  /// Nothing before the first epoch.
  std::optional<Time> gps_time_of(Time own) const;

 private:
  int epochs_{0};
  Time own_{};
  Time gps_{};
  double rate_{0.0};  // of GPS time per own time, less one
};

}  // namespace leeway
