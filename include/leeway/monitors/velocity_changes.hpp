/// @file
/// The age of a receiver's velocities, told by their changes alone.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/time.hpp"
#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// Compares how velocities change from fix to fix with what the IMU has felt in between. Of a
/// filter it needs the attitude alone, so that it still tells when the filter refuses the fixes. No
/// heap, no exceptions. Source: docs/theory/monitors/clock_monitor.md.
class VelocityChanges {
 public:
  struct Age {
    double value_s;
    double sigma_s;
  };

  /// A change of velocity that the IMU has felt; ECEF.
  void feel(const Eigen::Vector3d& dv_e_mps) { felt_e_mps_ += dv_e_mps; }

  /// @param a_e_mps2     acceleration at the time of the fix, by the IMU
  /// @param lever_e_mps  velocity of the antenna about the IMU
  /// @param down_e       unit vector
  /// @pre fix.velocity.
  void push(const GnssFix& fix, const Eigen::Vector3d& a_e_mps2, const Eigen::Vector3d& lever_e_mps,
            const Eigen::Vector3d& down_e);

  /// The age of the last half minute, where it is beyond chance another one, and explains most of
  /// what there is. @param known_s  the age that is known
  std::optional<Age> other_than(double known_s) const;

  /// Later velocities come with this much taken out of their age.
  void take_out(double age_s);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(time_, v_e_mps_, a_e_mps2_, lever_e_mps_, variance_m2ps2_, felt_e_mps_, information_,
            pull_, square_, count_);
  }

 private:
  std::optional<Time> time_{};  // of the newest velocity, and what there was then
  Eigen::Vector3d v_e_mps_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d a_e_mps2_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d lever_e_mps_{Eigen::Vector3d::Zero()};
  double variance_m2ps2_{0.0};
  Eigen::Vector3d felt_e_mps_{Eigen::Vector3d::Zero()};  // since
  // Of the age, and of an error of the heading: within one turn they look alike.
  Eigen::Matrix2d information_{Eigen::Matrix2d::Zero()};
  Eigen::Vector2d pull_{Eigen::Vector2d::Zero()};
  double square_{0.0};
  double count_{0.0};  // components
};

}  // namespace leeway
