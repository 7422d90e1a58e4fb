/// @file
/// The positions of a GNSS log against its own velocities: signs, axes, units, lag, scatter.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sim/inspect/log_look.hpp"
#include "sim/inspect/record_times.hpp"

namespace leeway::sim {

/// Sums of a way by positions and the same way by velocities, NED, over windows of about 10 s.
struct WaySums {
  std::int64_t windows{0};
  Eigen::Matrix3d by_positions_m2{Eigen::Matrix3d::Zero()};   ///< p p'
  Eigen::Matrix3d across_m2{Eigen::Matrix3d::Zero()};         ///< p v'
  Eigen::Matrix3d by_velocities_m2{Eigen::Matrix3d::Zero()};  ///< v v'
};

/// The fixes of a log, one after the other.
class OwnVelocity {
 public:
  void add(const GnssFix& fix);

  FixFigures figures() const;

  /// What contradicts, at most one finding for the horizontal and one for the vertical.
  std::vector<Finding> findings() const;

 private:
  struct Way {
    Eigen::Vector3d by_positions_m{Eigen::Vector3d::Zero()};
    Eigen::Vector3d by_velocities_m{Eigen::Vector3d::Zero()};
    double duration_s{0.0};
    Eigen::Vector3d first_v_n_mps{Eigen::Vector3d::Zero()};
  };

  void add_step(const GnssFix& before, const GnssFix& fix);
  void end_window(const Eigen::Vector3d& last_v_n_mps);
  double lag_sigma_s() const;

  RecordTimes times_{};
  FixFigures counts_{};
  std::optional<GnssFix> last_{};
  Eigen::Vector3d v_n_mps_{Eigen::Vector3d::Zero()};  ///< of last_, in the axes of its place
  Geodetic place_{};
  double claimed_m2_{0.0};
  std::int64_t steps_{0};
  double step_misses_m2_{0.0};
  Way way_{};
  WaySums sums_{};
  double window_misses_m2_{0.0};
  double lag_changes_m_mps_{0.0};
  double lag_changes_m2ps2_{0.0};
};

}  // namespace leeway::sim
