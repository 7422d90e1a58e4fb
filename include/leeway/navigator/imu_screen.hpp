/// @file
/// What shows on IMU data by itself that it is none: values that no longer change.
#pragma once

#include <array>
#include <cstddef>

#include "leeway/sensors/imu.hpp"

namespace leeway {

/// Watches the six axes for a value that stays the same to the last bit: a sensor that is stuck, or
/// at the end of its range. One that has never changed has no noise, and is a simulation. No heap,
/// no exceptions. Source: docs/theory/navigator/screens.md.
class ImuScreen {
 public:
  static constexpr double kHeldS = 0.25;        ///< and at least
  static constexpr int kHeldIncrements = 12;    ///< coarse steps repeat themselves by chance

  /// @returns whether an axis has been held for longer than chance allows on a vehicle that moves.
  /// @pre inc.dt_s > 0.
  bool is_held(const ImuIncrement& inc);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    for (Axis& axis : axes_) archive(axis.value, axis.held_s, axis.held, axis.changes);
  }

 private:
  struct Axis {
    double value{0.0};
    double held_s{0.0};
    int held{0};     // increments in a row
    int changes{0};  // seen so far, up to kHeldIncrements
  };
  static bool note(Axis& axis, double value, double dt_s);

  std::array<Axis, 6> axes_{};  // rad/s and m/s^2
};

}  // namespace leeway
