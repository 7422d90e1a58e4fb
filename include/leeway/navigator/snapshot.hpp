/// @file
/// A navigator's state as bytes, to survive a restart.
#pragma once

#include <cstdint>

#include "leeway/earth/names.hpp"

namespace leeway {

/// The form of the bytes. Any change of what a snapshot holds changes it.
inline constexpr std::uint32_t kSnapshotVersion = 7;

/// What became of an attempt to restore. Anything but kRestored changes nothing.
enum class Restore : std::uint8_t {
  kRestored,
  kNotASnapshot,        ///< it does not begin like one of this kind of machine
  kOtherVersion,        ///< written by another version of the library
  kOtherConfiguration,  ///< of a navigator configured otherwise
  kWrongSize,           ///< cut off, or more than a snapshot
  kDamaged,             ///< the checksum does not fit
};
constexpr auto names(Restore) {
  return std::array{"restored",   "not a snapshot", "other version", "other configuration",
                    "wrong size", "damaged"};
}

}  // namespace leeway
