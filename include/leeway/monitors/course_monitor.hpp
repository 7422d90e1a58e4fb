/// @file
/// Whether heading and course go together, on a vehicle that goes where it points.
#pragma once

#include "leeway/ekf/ekf.hpp"
#include "leeway/monitors/nis_cusum.hpp"
#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// Compares the course over ground with the heading. Their difference is that of mount and slip,
/// which lasts: when it changes by more than heading, course and slip allow, the heading is wrong.
/// Nothing is fused. No heap, no exceptions. Source: docs/theory/navigator/gate_recovery.md.
class CourseMonitor {
 public:
  /// @param offset_sigma_rad  of the difference before any fix
  /// @param drift_rad         1 sigma by which wind and water change it
  CourseMonitor(double offset_sigma_rad, double drift_rad)
      : drift_rad_(drift_rad), offset_variance_rad2_(offset_sigma_rad * offset_sigma_rad) {}

  /// @param filter  at the time of the fix. @pre fix.velocity.
  /// @returns whether the heading is wrong, beyond chance; the difference is then learned anew
  bool push(const GnssFix& fix, const Ekf& filter);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(offset_variance_rad2_, offset_rad_, learned_heading_rad2_, previous_, cusum_);
  }

 private:
  void learn(double change_rad, double course_rad2, double heading_rad2, double since_s);

  double drift_rad_;
  double offset_variance_rad2_;
  double offset_rad_{0.0};            // course minus heading
  double learned_heading_rad2_{0.0};  // of the heading's error that the offset has taken in
  std::optional<Time> previous_{};
  NisCusum cusum_{};
};

}  // namespace leeway
