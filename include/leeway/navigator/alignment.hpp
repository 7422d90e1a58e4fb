/// @file
/// Alignment: the first attitude, from the specific force and the GNSS course.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/fields.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/navigator/measured_heading.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"

namespace leeway {

/// Roll and pitch that take the measured mean specific force to the expected one in the levelled
/// frame (forward, right, down along the heading). At rest f_level = (0, 0, -g): static levelling.
/// Yaw is 0 in the result. @pre f_b is not zero. Source: Groves (2013) (5.101), generalized.
EulerAngles level(const Eigen::Vector3d& f_b_mps2, const Eigen::Vector3d& f_level_mps2);

struct AlignmentConfig {
  /// Whether the vehicle points where it goes and its axes are known. If not, it starts with a
  /// heading that is anywhere on the circle.
  bool heading_from_course{true};
  double min_speed_mps{3.0};       ///< course is taken as heading from this speed on
  double sideslip_rad{0.05};       ///< 1 sigma of heading against course: slip and mount
  double tilt_floor_rad{0.03};     ///< 1 sigma of levelling beyond what the fixes explain
  double max_fix_interval_s{2.5};  ///< two fixes further apart than this give no acceleration
  double rest_speed_mps{0.2};      ///< below this a fix counts as at rest
  double rest_turn_rad{0.01};      ///< ... if the IMU turned less than this since the fix before,
                                   ///< beyond its turn-on bias
  double min_level_s{1.0};         ///< a rest this long is enough to level
  double min_rest_s{3.0};          ///< a rest this long gives the gyro bias

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"heading_from_course", c.heading_from_course},
                   Field{"min_speed_mps", c.min_speed_mps, kPositive},
                   Field{"sideslip_rad", c.sideslip_rad, kPositive},
                   Field{"tilt_floor_rad", c.tilt_floor_rad, kPositive},
                   Field{"max_fix_interval_s", c.max_fix_interval_s, kPositive},
                   Field{"rest_speed_mps", c.rest_speed_mps, kPositive},
                   Field{"rest_turn_rad", c.rest_turn_rad, kPositive},
                   Field{"min_level_s", c.min_level_s, kPositive},
                   Field{"min_rest_s", c.min_rest_s, kPositive});
  }
};

/// What an alignment found: a start for the filter.
struct Alignment {
  Estimate estimate{};
  ErrorMatrix P{ErrorMatrix::Zero()};
  /// Beside P the attitude is uncertain by a turn about this axis (ECEF, unit): what levelling
  /// leaves open.
  Eigen::Vector3d axis_e{Eigen::Vector3d::UnitZ()};
  double turn_sigma_rad{0.0};
  bool from_course{false};  ///< its heading is the course: wrong by half a turn where it backs
};

/// Collects IMU data and fixes until the attitude can be told. With heading from course that is
/// when the vehicle moves fast enough; a long wait at a standstill is normal, and yields the gyro
/// bias. Without, it is levelled after a rest, or on the move by two fixes in a row, and its
/// heading is left open. A measured heading takes the place of either: then the vehicle starts
/// levelled, with that heading. Fixes up to a minute apart, and positions without velocity (three,
/// evenly spaced over 8 s and more), are levelled by what the IMU has integrated in between. No
/// heap, no exceptions after construction.
class Aligner {
 public:
  /// @throws Error when the configuration is invalid.
  Aligner(const AlignmentConfig& config, const EkfConfig& filter);

  /// @pre inc.dt_s > 0.
  void push(const ImuIncrement& inc);

  /// A heading at the present: the gyro carries it on to the fix that aligns. Of several the
  /// majority counts, by the newest of them; while they are even, none.
  void push(const MeasuredHeading& heading);

  /// The alignment at the time of this fix, as soon as the fixes so far allow it. A fix that was
  /// cut in two for its lags is put together again. @pre is_usable(fix); increments up
  /// to fix.time have been pushed.
  std::optional<Alignment> push(const GnssFix& fix);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(previous_, half_, since_fix_, rest_, newest_velocity_, first_, middle_, since_first_,
            until_middle_, heading_, since_heading_, votes_);
  }

 private:
  /// A change of velocity, and what the IMU felt of it. Both are means over `over_s` in effect.
  struct Push {
    Eigen::Vector3d dv_e_mps;
    Eigen::Vector3d felt_mps;  ///< specific force, integrated; axes of the body at the start
    double over_s;
    Eigen::Quaterniond q_start_end;
    double sigma_mps;  ///< of dv_e_mps
    double turn_rad;   ///< since the course was as the fix says
  };

  std::optional<Alignment> take(const GnssFix& fix);
  std::optional<Alignment> take_position(const GnssFix& fix);
  std::optional<Alignment> align_apart(const GnssFix& fix, const GnssVelocity& before) const;
  std::optional<Alignment> align_by(const Push& push, const GnssFix& fix) const;
  bool watch_rest(const GnssVelocity& velocity);
  Alignment align_by_course(const GnssFix& fix, const GnssVelocity& before) const;
  Alignment level_only(const GnssFix& fix, const GnssVelocity& before, bool at_rest) const;
  void set_rest_bias(Alignment& alignment) const;
  double carried_sigma_rad() const;
  void turn_to_heading(Alignment& alignment) const;

  struct Sum {
    template <class Archive>
    void visit(Archive& archive) {
      archive(dt_s, dtheta_b_rad, dv_b_mps, q_start_end, dv_start_mps, dr_start_m);
    }

    void add(const ImuIncrement& inc);

    double dt_s{0.0};
    Eigen::Vector3d dtheta_b_rad{Eigen::Vector3d::Zero()};  // the plain sums
    Eigen::Vector3d dv_b_mps{Eigen::Vector3d::Zero()};
    Eigen::Quaterniond q_start_end{Eigen::Quaterniond::Identity()};  // from the first body axes
    Eigen::Vector3d dv_start_mps{Eigen::Vector3d::Zero()};  // specific force, integrated in them
    Eigen::Vector3d dr_start_m{Eigen::Vector3d::Zero()};    // ... and once more
  };

  AlignmentConfig config_;
  EkfConfig filter_;
  std::optional<GnssFix> previous_{};
  std::optional<GnssFix> half_{};  // waits for its other half
  Sum since_fix_{};
  Sum rest_{};
  std::optional<Time> newest_velocity_{};
  std::optional<GnssFix> first_{};  // of three positions without velocity
  std::optional<GnssFix> middle_{};
  Sum since_first_{};
  Sum until_middle_{};
  MeasuredHeading heading_{};
  Sum since_heading_{};
  int votes_{0};  // for the heading
};

}  // namespace leeway
