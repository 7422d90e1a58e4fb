/// @file
/// The turns of a GNSS log's course against those of an IMU log: the clocks' offset, the unit and
/// the signs of the gyros; and where the IMU gains the speed that the receiver tells of.
#pragma once

#include <Eigen/Core>
#include <array>
#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>

#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/sim/inspect/log_look.hpp"

namespace leeway::sim {

/// What the turns say.
struct TurnMatch {
  std::int64_t pairs{0};
  double offset_s{kUnseen};  ///< the course of a time t fits the gyros at t + offset
  double offset_sigma_s{kUnseen};
  double ratio{kUnseen};  ///< turn of the course over that of the gyros, at that offset
  double ratio_sigma{kUnseen};
  double correlation{0.0};  ///< at that offset, signed
  double lead_m{kUnseen};   ///< antenna ahead of the point that does not slide sideways
};

/// The two logs side by side, an increment and a fix after the other.
class SharedTurns {
 public:
  void add(const ImuIncrement& inc);
  void add(const GnssFix& fix);

  TurnMatch match() const;

  /// Unit vector in body axes; nothing where speed changes are too few or do not fit.
  std::optional<Eigen::Vector3d> forward_b() const;

 private:
  /// Of the history and of the offsets that are tried.
  static constexpr Duration kStep = std::chrono::milliseconds{100};
  static constexpr double kStepS = to_seconds(kStep);
  static constexpr int kMostSteps = 200;  ///< 20 s: leap seconds are below
  static constexpr std::size_t kOffsets = 2 * kMostSteps + 1;
  static constexpr int kRateSteps = 2;  ///< on both sides, over which a turn rate is taken
  static constexpr std::size_t kTurns = kOffsets + 2 * kRateSteps;
  using Turns = std::array<double, kTurns>;

  struct Course {
    Time time{};
    double angle_rad{};
    double speed_mps{};
    double sigma_rad{};
  };
  struct Pair {
    Course from{};
    Course to{};
  };
  /// Weighted sums of a line y = a + b x + l z for one offset: turns of the gyros x, of the course
  /// y, and the change of turn rate over speed z, by which a point ahead of the axle leads.
  struct Sums {
    double x{0.0};
    double z{0.0};
    double xx{0.0};
    double xz{0.0};
    double zz{0.0};
    double xy{0.0};
    double zy{0.0};
  };
  /// The line that fits best.
  struct Line {
    double b{};
    double l{};
    double residual_rad2{};
    double b_per_residual{};  ///< variance of b over that of a turn
  };
  /// Integrals since the begin, at a multiple of kStepS.
  struct Past {
    double turn_rad{0.0};
    Eigen::Vector3d dv_b_mps{Eigen::Vector3d::Zero()};
  };

  std::optional<Course> course_of(const GnssFix& fix) const;
  /// Pairs whose history is whole, for the offsets on both sides.
  void judge_pairs();
  void judge(const Pair& pair);
  /// The specific force against the speed gained.
  void judge_gain(const Pair& pair);
  /// Integrals at a time; nothing outside the history.
  std::optional<Past> at(Time t) const;
  /// Turns of the gyros at a time, for every offset and kRateSteps beyond; nothing where the
  /// history has not all of them.
  std::optional<Turns> turns_around(Time t) const;
  Line line(std::size_t k) const;

  std::deque<Past> history_{};
  std::int64_t first_step_{0};  ///< of history_
  Past now_{};
  Eigen::Vector3d down_b_{Eigen::Vector3d::Zero()};
  double levelled_s_{0.0};
  std::optional<Time> last_time_{};
  std::optional<GnssFix> last_fix_{};
  std::optional<Course> last_{};
  std::deque<Pair> pairs_{};
  std::optional<Pair> newest_{};
  std::int64_t gains_{0};
  std::int64_t judged_{0};
  double weights_{0.0};
  double y_{0.0};
  double yy_{0.0};
  std::array<Sums, kOffsets> sums_{};
  double gains_m2ps4_{0.0};
  double gain_sum_mps2_{0.0};
  Eigen::Vector3d forces_mps2_{Eigen::Vector3d::Zero()};
  Eigen::Vector3d gain_forces_m2ps4_{Eigen::Vector3d::Zero()};
  double force_squares_m2ps4_{0.0};
};

}  // namespace leeway::sim
