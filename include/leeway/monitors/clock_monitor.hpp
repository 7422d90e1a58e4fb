/// @file
/// The offset of the receiver's clock against the IMU's, told by when both feel the same motion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>

#include "leeway/earth/time.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/monitors/lag_fit.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"

namespace leeway {

/// How much older than stamped the parts of a fix are, s: 0 is the position, 1 the velocity.
using FixAge = Eigen::Vector2d;

/// What is known of the age of fixes.
struct ClockOffset {
  Age age{};                ///< of both parts, or of the velocity alone
  bool of_velocity{false};  ///< of the velocities alone: the positions are right

  template <class Archive>
  void visit(Archive& archive) {
    archive(age, of_velocity);
  }
};

/// Compares what a receiver says of the motion with what the IMU feels of it, at several times
/// around that of the fix. Velocities are compared where there are any, and positions. Nothing
/// shows while the motion is steady. A lever arm that is not told of looks alike: 1 m at 10 m/s
/// like 0.1 s. No heap, no exceptions. Source: docs/theory/monitors/clock_monitor.md.
class ClockMonitor {
 public:
  /// @param lever_arm_b_m  IMU to antenna, body axes
  explicit ClockMonitor(const Eigen::Vector3d& lever_arm_b_m) : lever_arm_b_m_(lever_arm_b_m) {}

  /// @param inc       in body axes
  /// @param estimate  at its end
  void push(const ImuIncrement& inc, const Estimate& estimate);

  /// Parts of a fix, at the times at which they are fused. Either may be absent.
  void push(const GnssFix& fix);

  /// A hole, or another attitude: what was felt before is forgotten. The offset stays.
  void restart();

  /// What is known of the age, less taken_out_s().
  const ClockOffset& offset() const { return offset_; }

  /// By how much fixes are to be taken for older than stamped; zero before take_out().
  const FixAge& taken_out_s() const { return taken_out_s_; }

  bool is_taken_out() const { return !taken_out_s_.isZero(0.0); }

  /// Takes the offset out from here on. @pre offset().age.beyond_chance.
  void take_out();

  /// What the offset adds to the covariance of the error state: its square once it is beyond
  /// chance, and the part of its sigma where it is taken out.
  ErrorMatrix covariance(const Estimate& estimate) const;

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(points_, newest_, count_, motion_, down_e_, rate_e_radps_, acceleration_e_mps2_,
            waiting_, waiting_count_, last_s_, velocities_, positions_, last_position_,
            last_position_s_, has_position_, offset_, taken_out_s_, left_sigma_s_, origin_e_m_,
            begun_, has_begun_);
  }

 private:
  static constexpr double kStepS = 0.1;  // a vehicle moves smoothly in it
  static constexpr std::size_t kPoints = 64;
  static constexpr std::size_t kWaiting = 16;

  /// The antenna's way and velocity by the IMU alone, from some start.
  struct Motion {
    double t_s{0.0};  // since begun_
    Eigen::Vector3d v_e_mps{Eigen::Vector3d::Zero()};
    Eigen::Vector3d way_e_m{Eigen::Vector3d::Zero()};

    template <class Archive>
    void visit(Archive& archive) {
      archive(t_s, v_e_mps, way_e_m);
    }
  };

  /// A position or a velocity that waits until the motion after it is known.
  struct Measured {
    double t_s{0.0};
    bool is_velocity{false};
    Eigen::Vector3d value{Eigen::Vector3d::Zero()};
    double sigma{1.0};

    template <class Archive>
    void visit(Archive& archive) {
      archive(t_s, is_velocity, value, sigma);
    }
  };

  const Motion& point(std::size_t age) const {
    return points_[(newest_ + kPoints - age) % kPoints];
  }
  void wait(Time time, bool is_velocity, const Eigen::Vector3d& value, double sigma);
  void compare(const Measured& measured);
  std::optional<LagFit::Pairs> beside_motion(const Measured& measured) const;
  void compare_way(const LagFit::Pairs& pairs, const Measured& position);
  void judge();

  Eigen::Vector3d lever_arm_b_m_;
  std::array<Motion, kPoints> points_{};  // ring
  std::size_t newest_{0};
  std::size_t count_{0};
  Motion motion_{};  // of the IMU, not of the antenna
  Eigen::Vector3d down_e_{Eigen::Vector3d::UnitZ()};
  Eigen::Vector3d rate_e_radps_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d acceleration_e_mps2_{Eigen::Vector3d::Zero()};
  std::array<Measured, kWaiting> waiting_{};
  std::size_t waiting_count_{0};
  std::array<double, 2> last_s_{-1e9, -1e9};  // of what waited last: position, velocity
  LagFit velocities_{};
  LagFit positions_{};
  LagFit::Pairs last_position_{};  // whose way to the next one is compared
  double last_position_s_{0.0};
  bool has_position_{false};
  ClockOffset offset_{};
  FixAge taken_out_s_{FixAge::Zero()};
  double left_sigma_s_{0.0};
  Eigen::Vector3d origin_e_m_{Eigen::Vector3d::Zero()};
  Time begun_{};
  bool has_begun_{false};
};

}  // namespace leeway
