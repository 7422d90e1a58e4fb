/// @file
/// What shows on a fix by itself that it is none: no position, or the one before once more.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// Looks at fixes before a filter does. No heap, no exceptions. Source:
/// docs/theory/monitors/screens.md.
class FixScreen {
 public:
  enum class Finding : std::uint8_t {
    kNews,
    kRepeated,  ///< equal to the one before to the last bit, while the vehicle moves
    kNone,      ///< 0, 0: what drivers send in place of a position
  };

  /// @param moves  whether the vehicle moves, by its filter; a moving receiver never gives the same
  /// numbers twice
  Finding judge(const GnssFix& fix, bool moves);

  /// The fix with no sigma below 1 mm and 1 mm/s in any direction: no receiver does better. Nor is
  /// it believed to do better than a third of what it claimed before: a receiver that improves goes
  /// on to claim so, a slip of the log does not.
  GnssFix with_floor(const GnssFix& fix);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(position_, velocity_, floor_m_, floor_mps_);
  }

 private:
  std::optional<Eigen::Vector3d> position_{};  // of the newest news, by part
  std::optional<Eigen::Vector3d> velocity_{};
  double floor_m_{0.0};  // a third of what was last believed
  double floor_mps_{0.0};
};

}  // namespace leeway
