/// @file
/// The true increments of a scene, computed once and shared by all trials.
#pragma once

#include <cstddef>
#include <vector>

#include "leeway/sensors/imu.hpp"
#include "leeway/sim/motion/trajectory.hpp"

namespace leeway::sim {

/// True increments of a motion, 64 bytes each. One period is stored when it is a whole number of
/// increments and of nanoseconds, otherwise the whole duration. Safe to share between threads.
class TrueIncrements {
 public:
  /// Consecutive increments that end at k / rate_hz, from 0 to the duration.
  /// @param threads  number of threads that compute them, as for parallel_for()
  /// @throws Error as true_increments(), or when more than 2^26 increments would be stored.
  TrueIncrements(const Trajectory& trajectory, double rate_hz, double duration_s, int threads = 0);

  std::size_t size() const { return size_; }
  std::size_t stored() const { return stored_.size(); }

  /// The increment that ends at (k + 1) / rate_hz. @pre k < size().
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
