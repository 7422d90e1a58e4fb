/// @file
/// What shows on IMU data by itself that it is none: values that no longer change.
#pragma once

#include <array>
#include <cstddef>

#include "leeway/sensors/imu.hpp"

namespace leeway {

/// Watches the six axes for a value that stays the same to the last bit: a sensor that is stuck, or
/// at the end of its range. One without noise is a simulation: its changes are smooth, and it may
/// well stay the same. Its noise must be that of MEMS sensors, 1e-5 rad/s and 1e-4 m/s^2 at least:
/// better ones that are stuck are not told. No heap, no exceptions.
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
    for (Axis& axis : axes_) axis.visit(archive);
  }

 private:
  struct Axis {
    double value{0.0};
    double held_s{0.0};
    double change{0.0};       // the newest
    double mean_change{0.0};  // of its size, over the last few
    double mean_bend{0.0};    // ... and of the change of the change: of noise it is the larger
    int held{0};              // increments in a row

    template <class Archive>
    void visit(Archive& archive) {
      archive(value, held_s, change, mean_change, mean_bend, held);
    }
  };
  static bool note(Axis& axis, double value, double dt_s, double least_noise);

  std::array<Axis, 6> axes_{};  // rad/s and m/s^2
};

}  // namespace leeway
