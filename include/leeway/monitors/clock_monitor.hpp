/// @file
/// The offset of the receiver's clock against the IMU's, told by what it leaves in the innovations.
#pragma once

#include <Eigen/Core>

#include "leeway/ekf/ekf.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/monitors/velocity_changes.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"

namespace leeway {

/// How much older than stamped the parts of a fix are, s: 0 is the position, 1 the velocity.
using FixAge = Eigen::Vector2d;

/// The age of fixes, one for both of their parts or of the velocity alone.
struct ClockOffset {
  FixAge age_s{FixAge::Zero()};
  double value_s{0.0};        ///< the age that is not zero
  double sigma_s{1.0};        ///< 1 s: as before anything is known
  bool of_velocity{false};    ///< of the velocities alone: the positions are right
  bool beyond_chance{false};  ///< five sigmas, and 20 ms at least

  template <class Archive>
  void visit(Archive& archive) {
    archive(age_s, value_s, sigma_s, of_velocity, beyond_chance);
  }
};

/// Kalman's filter of the ages beside an EKF, which it leaves as it is. It carries how far the
/// error state depends on the ages, U = dx / d(age), and how far it errs by them. No heap, no
/// exceptions. Source: Friedland (1969); docs/theory/monitors/clock_monitor.md.
class ClockMonitor {
 public:
  /// @param gnss_correlation_s  of the errors of positions, as the filter takes them
  explicit ClockMonitor(double gnss_correlation_s) : position_weight_(gnss_correlation_s) {}

  /// Right after the filter was advanced by inc.
  void push(const ImuIncrement& inc, const Ekf& filter) {
    since_step_s_ += inc.dt_s;
    if (since_step_s_ + 0.5 * inc.dt_s > kStepS) reach(filter);
  }

  /// Comes up to the time of the filter: right before a measurement.
  void reach(const Ekf& filter);

  /// After a fix, fused or refused.
  /// @param trust     with which the filter took it
  /// @param is_sound  whether the filter is the only one, so that its innovations tell of the ages
  void take(const GnssFix& fix, const UpdateOutcome& outcome, const FixTrust& trust,
            const Ekf& filter, bool is_sound);

  /// After another measurement was fused: of the IMU's clock, so that its innovation tells nothing.
  void take(const Measurement& m, const Ekf& filter);

  /// At rest nothing depends on when.
  void rest(const Ekf& filter);

  /// The filter is another one: it has followed the fixes, late as they are. The ages stay.
  void restart(const Ekf& filter) {
    has_begun_ = false;
    v_e_mps_ = filter.estimate().nav.v_e_mps;
  }

  /// What is known of the ages, with what is taken out.
  const ClockOffset& offset() const { return offset_; }

  /// By how much fixes are taken for older than stamped.
  const FixAge& taken_out_s() const { return taken_out_s_; }

  /// How far the error state is moved by an age of both parts, per second of it.
  ErrorVector sensitivity_per_s() const { return track_.U.topRows<kErrorStates>().rowwise().sum(); }

  /// Takes the offset out, once it is beyond chance, and follows it from there on. Later fixes are
  /// to be shifted by taken_out_s().
  /// @returns by what the estimate is to be corrected; zero for nothing
  JointVector take_out();

  /// What the offset adds to the covariance of the error state, where it is beyond chance: the
  /// square of what is not taken out, and the part of its sigma.
  ErrorMatrix covariance() const;

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(track_, changes_, offset_, taken_out_s_, position_weight_, since_step_s_, v_e_mps_,
            a_e_mps2_, nis_ratio_, newest_, begun_, has_begun_, is_followed_);
  }

 private:
  static constexpr double kStepS = 0.1;  // a vehicle moves smoothly in it

  struct Rows;

  struct Track {
    Eigen::Matrix<double, kJointStates, 2> U{Eigen::Matrix<double, kJointStates, 2>::Zero()};
    JointVector error{JointVector::Zero()};  // of the filter, by the ages: the mean
    FixAge age_s{FixAge::Zero()};            // less what is taken out
    Eigen::Matrix2d M_s2{Eigen::Matrix2d::Identity()};

    void forget(double factor, double variance_s2);
    double pass(const Rows& rows, double nis_scale);

    template <class Archive>
    void visit(Archive& archive) {
      archive(U, error, age_s, M_s2);
    }
  };

  void begin(const Eigen::Vector3d& v_e_mps);
  void begin_anew(const Eigen::Vector3d& v_e_mps, const UpdateOutcome& outcome);
  void set_anew(double age_s, double sigma_s);
  void learn(const Rows& rows, double dt_s);
  ClockOffset fit() const;

  Track track_{};
  VelocityChanges changes_{};
  ClockOffset offset_{};
  FixAge taken_out_s_{FixAge::Zero()};
  PositionWeight position_weight_;
  double since_step_s_{0.0};
  Eigen::Vector3d v_e_mps_{Eigen::Vector3d::Zero()};  // at the newest step or measurement
  Eigen::Vector3d a_e_mps2_{Eigen::Vector3d::Zero()};
  double nis_ratio_{1.0};  // of what the ages leave unexplained, to its expectation
  Time newest_{};          // fix
  Time begun_{};
  bool has_begun_{false};
  bool is_followed_{false};  // it was taken out once
};

}  // namespace leeway
