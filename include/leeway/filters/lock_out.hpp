/// @file
/// What to do when the gate refuses one fix after another.
#pragma once

#include <cstdint>
#include <optional>

#include "leeway/filters/ekf.hpp"
#include "leeway/gnss_fix.hpp"
#include "leeway/time.hpp"

namespace leeway {

/// Counts the fixes refused in a row. Chance alone does not refuse three: from there on the filter
/// is what is wrong, and the remedies grow with the row. No heap, no exceptions.
class LockOut {
 public:
  enum class Remedy : std::uint8_t {
    kWait,     ///< it may be an outlier
    kWiden,    ///< P by kWidening
    kRestart,  ///< position and velocity anew from the fix
    kRealign,  ///< the attitude is wrong too: that has been tried within the last minutes
  };
  static constexpr double kWidening = 2.0;

  /// The gate has refused a fix of this time.
  Remedy refused(Time t, bool has_position);

  /// A fix was fused, or motion began anew: the row has ended.
  void end() {
    in_a_row_ = 0;
    since_.reset();
  }

  /// Everything began anew: earlier rows say nothing of it.
  void forget() {
    end();
    first_lock_out_.reset();
  }

  /// Whether the newest fix was refused.
  bool is_row() const { return in_a_row_ > 0; }

  /// The first of the fixes refused in a row.
  const std::optional<Time>& since() const { return since_; }

  template <class Archive>
  void visit(Archive& archive) {
    archive(since_, last_restart_, first_lock_out_, lock_outs_, in_a_row_);
  }

 private:
  bool comes_back(Time t);

  std::optional<Time> since_{};
  std::optional<Time> last_restart_{};
  std::optional<Time> first_lock_out_{};
  std::uint32_t lock_outs_{0};
  std::uint32_t in_a_row_{0};
};

/// Position and velocity anew, as the fix has them; a velocity that it lacks is the filter's own,
/// with 30 m/s of sigma. @pre fix.position, and is_usable(fix).
void restart_motion(Ekf& filter, const GnssFix& fix);

}  // namespace leeway
