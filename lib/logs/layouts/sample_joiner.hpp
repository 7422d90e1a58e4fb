/// @file
/// Rates and specific forces that are logged apart, as samples. Private to the log readers.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>

#include "leeway/earth/time.hpp"
#include "lib/logs/layouts/imu_layouts.hpp"

namespace leeway {

/// Joins two series in the order of time, each in bounded memory: a sample is at the time of a
/// rate, its specific force linear between those around it.
class SampleJoiner {
 public:
  void add_rate(Time time, const Eigen::Vector3d& rate_radps) { add(rates_, {time, rate_radps}); }
  void add_force(Time time, const Eigen::Vector3d& force_mps2) { add(forces_, {time, force_mps2}); }

  /// Whether a sample is complete. Rates without forces around them, within half a second, are
  /// dropped.
  bool has_next();

  /// @pre has_next().
  ImuRow next();

  /// The series that is behind, and has to go on before there is a next sample.
  bool needs_force() const;

 private:
  struct Vector {
    Time time{};
    Eigen::Vector3d value{};
  };
  static void add(std::deque<Vector>& series, const Vector& vector);

  std::deque<Vector> rates_;
  std::deque<Vector> forces_;
};

}  // namespace leeway
