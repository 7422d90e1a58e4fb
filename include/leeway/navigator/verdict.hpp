/// @file
/// What became of an input.
#pragma once

#include <cstddef>
#include <cstdint>

#include "leeway/earth/names.hpp"

namespace leeway {

/// Bad data is an outcome, not an error: it is counted and changes nothing else, except that a gap
/// in the IMU data is bridged.
enum class Verdict : std::uint8_t {
  kAccepted,     ///< IMU: integrated; else: waits for the IMU data of its time
  kAligning,     ///< taken for alignment; there is no solution yet
  kFused,        ///< the measurement corrected the state
  kGated,        ///< it was too far from the prediction for both to be right
  kPartly,       ///< so was one of position and velocity; the other corrected the state
  kReset,        ///< the gate had locked out fixes that agree: position and velocity begin anew
  kGap,          ///< IMU data was missing for longer than max_gap_s: it was bridged
  kLate,         ///< older than what is kept to go back to
  kDuplicate,    ///< same time and kind as one before; an increment is added to the next one
  kRepeated,     ///< a fix equal to the one before to the last bit, while the vehicle moves
  kOutOfOrder,   ///< IMU data older than the newest; measurements may come in any order
  kFuture,       ///< further ahead of the IMU data than max_ahead_s
  kClockJump,    ///< IMU: the clock has jumped for good; the navigator aligns anew
  kUnused,       ///< this aiding is switched off, or tells nothing in this attitude
  kNotFinite,    ///< NaN or infinity
  kImplausible,  ///< beyond what the sensor can measure, or not a covariance
  kOverflow,     ///< more measurements wait than there is room for
};
constexpr auto names(Verdict) {
  return std::array{"accepted", "aligning",     "fused",  "gated",      "partly", "reset",
                    "gap",      "late",         "duplicate", "repeated", "out_of_order", "future",
                    "clock_jump", "unused",     "not_finite", "implausible", "overflow"};
}

inline constexpr std::size_t kVerdicts = kAll<Verdict>.size();

}  // namespace leeway
