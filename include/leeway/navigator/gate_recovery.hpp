/// @file
/// What to do when the gate refuses one fix after another.
#pragma once

#include <cstdint>
#include <optional>

#include "leeway/earth/time.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// Counts the fixes refused in a row. Chance alone does not refuse three: from there on the filter
/// is what is wrong, and the remedies grow with the row. No heap, no exceptions.
class GateRecovery {
 public:
  enum class Remedy : std::uint8_t {
    kWait,     ///< it may be an outlier
    kWiden,    ///< P by kWidening
    kRestart,  ///< position and velocity anew from the fix
    kRealign,  ///< the attitude is wrong too: that has been tried within the last minutes
  };
  static constexpr double kWidening = 2.0;

  /// The gate has refused a fix.
  Remedy refused(const GnssFix& fix);

  void fused(const GnssFix& fix);

  /// Motion began anew: the row has ended.
  void end() {
    in_a_row_ = 0;
    since_.reset();
  }

  /// Everything but the IMU begins anew: earlier rows say nothing of it.
  void realigned(Time t) {
    end();
    first_lock_out_.reset();
    on_probation_since_ = t;
  }

  /// Taking everything anew did not end the refusal: what remains wrong is the IMU. Until thirty
  /// fixes are fused in a row, one that is refused and agrees with the one before is taken for
  /// position and velocity; for a minute after that the IMU is on probation.
  bool distrusts_imu() const { return distrusts_imu_; }

  /// Whether the newest fix was refused.
  bool is_row() const { return in_a_row_ > 0; }

  /// The first of the fixes refused in a row.
  const std::optional<Time>& since() const { return since_; }

  template <class Archive>
  void visit(Archive& archive) {
    archive(since_, last_restart_, on_probation_since_, first_lock_out_, previous_, lock_outs_,
            in_a_row_, fused_in_a_row_, distrusts_imu_);
  }

 private:
  Remedy remedy_for(const GnssFix& fix);
  bool comes_back(Time t);

  std::optional<Time> since_{};
  std::optional<Time> last_restart_{};
  std::optional<Time> on_probation_since_{};  // the IMU, since all else was taken anew
  std::optional<Time> first_lock_out_{};
  std::optional<GnssFix> previous_{};
  std::uint32_t lock_outs_{0};
  std::uint32_t in_a_row_{0};
  std::uint32_t fused_in_a_row_{0};
  bool distrusts_imu_{false};
};

/// Position and velocity anew, as the fix has them; a velocity that it lacks is the filter's own,
/// with 30 m/s of sigma. @pre fix.position, and is_usable(fix).
void restart_motion(Ekf& filter, const GnssFix& fix);

}  // namespace leeway
