/// @file
/// Whether the time of an IMU record can be right: duplicates, steps back, the end of a GPS week,
/// a clock that jumps.
#pragma once

#include <optional>

#include "leeway/earth/time.hpp"
#include "leeway/navigator/verdict.hpp"

namespace leeway {

/// A record after a hole is refused until a second one confirms it: its time may be wrong. Records
/// further off, or from the past, are believed when five in a row follow each other: then it is the
/// clock that has jumped. Seconds of week that begin anew are counted on. No heap, no exceptions.
class ImuClock {
 public:
  /// @param max_jump_s  a longer step ahead cannot be a hole
  /// @param max_gap_s   records follow each other when they are not further apart than this
  ImuClock(double max_jump_s, double max_gap_s);

  /// @returns kAccepted, kDuplicate, kOutOfOrder, kFuture, or kClockJump: the record is the first
  /// on a new time line.
  Verdict judge(Time t);

  /// The newest time believed, counted on over the ends of weeks.
  const std::optional<Time>& newest() const { return newest_; }

  /// t, which may count from the begin of another week, on the time line of newest().
  Time counted_on(Time t) const;

  /// Sets the time line, as a start from outside does.
  void set(Time newest);

  template <class Archive>
  void visit(Archive& archive) {
    archive(newest_, weeks_, doubted_, doubted_in_a_row_);
  }

 private:
  Duration max_jump_;
  Duration max_gap_;
  std::optional<Time> newest_{};
  Duration weeks_{0};
  std::optional<Time> doubted_{};  // the newest of the records refused in a row
  int doubted_in_a_row_{0};
};

}  // namespace leeway
