/// @file
/// The true increments of a scene, computed once and shared by all trials.
#pragma once

#include <cstddef>
#include <vector>

#include "leeway/sensors/imu.hpp"
#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

/// Of a motion whose period is a whole number of increments and of nanoseconds, one period is
/// stored; of any other, the whole duration, 64 bytes an increment. Safe to share between threads.
class TrueIncrements {
 public:
  /// Consecutive increments ending at k / rate_hz, from 0 to the duration; made on as many threads
  /// as parallel_for() is told.
  /// @throws Error as true_increments(), or when more than 2^26 increments would be stored.
  TrueIncrements(const Trajectory& trajectory, double rate_hz, double duration_s, int threads = 0);

  std::size_t size() const { return size_; }
  std::size_t stored() const { return stored_.size(); }

  /// @pre k < size().
  ImuIncrement operator[](std::size_t k) const {
    ImuIncrement inc = stored_[k % stored_.size()];
    inc.time += static_cast<Duration::rep>(k / stored_.size()) * period_;
    return inc;
  }

 private:
  std::size_t size_;
  Duration period_;  // of what is stored
  std::vector<ImuIncrement> stored_;
};

}  // namespace leeway::sim
