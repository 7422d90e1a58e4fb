/// @file
/// How good the IMU is, told by a filter that goes without fixes for a while.
#pragma once

#include <optional>

#include "leeway/ekf/ekf.hpp"
#include "leeway/sensors/imu.hpp"

namespace leeway {

/// Carries a copy of the filter on without any measurement, and compares its velocity with that of
/// the filter some ten seconds later. Fixes that come every second hide what the IMU drifts by in
/// between; this shows it. Learns a factor on the deviations of the IMU's noise, 0.3 to 30. No
/// heap, no exceptions. Source: docs/theory/monitors/coast_monitor.md.
class CoastMonitor {
 public:
  /// By what the model's deviations are to be multiplied; 1 before anything is known.
  double imu_sigma_scale() const { return imu_sigma_scale_; }

  /// @pre inc.dt_s > 0; it follows the one before, unless restart() was called in between.
  void push(const ImuIncrement& inc);

  /// At a fix: takes note once the copy has coasted for long enough, and copies anew.
  /// @param filter  at the time of the newest increment, with the fix in it
  /// @returns whether measurements have turned its heading by more than it claims: it is wrong
  bool compare(const Ekf& filter);

  /// Forgets the copy: what it was compared with is no longer the same filter.
  void restart() { copy_.reset(); }

  /// Names every member that changes, for a snapshot.
  /// @param any  filter of the same configuration
  template <class Archive>
  void visit(Archive& archive, const Ekf& any) {
    archive.optional(copy_, any);
    archive(start_, time_, dt_s_, dtheta_b_rad_, dv_b_mps_, imu_sigma_scale_, known_dof_);
  }

 private:
  bool compare_velocity(const Ekf& filter);
  void learn(double nis, double scale_of_copy);
  void catch_up();

  static constexpr double kPriorDof = 8.0;  // a model is believed like four comparisons

  std::optional<Ekf> copy_{};
  Time start_{};
  Time time_{};       // of the newest increment
  double dt_s_{0.0};  // increments that the copy is behind
  Eigen::Vector3d dtheta_b_rad_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d dv_b_mps_{Eigen::Vector3d::Zero()};
  double imu_sigma_scale_{1.0};
  double known_dof_{kPriorDof};  // how many squares the factor is a mean of
};

}  // namespace leeway
