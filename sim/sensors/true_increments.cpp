#include "leeway/sim/sensors/true_increments.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "leeway/earth/error.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/parallel.hpp"

namespace leeway::sim {
namespace {

constexpr std::size_t kMostStored = std::size_t{1} << 26;  // 4 GB
constexpr std::size_t kBlock = 4096;

bool is_whole(double x) { return std::abs(x - std::round(x)) < 1e-6; }

/// How many increments repeat; count where the motion does not within them.
std::size_t repeating(const Trajectory& trajectory, double rate_hz, std::size_t count) {
  if (!trajectory.period_s) return count;
  const double period_s = *trajectory.period_s;
  if (!is_whole(period_s * rate_hz) || !is_whole(period_s * 1e9)) return count;
  return std::clamp(static_cast<std::size_t>(std::llround(period_s * rate_hz)), std::size_t{1},
                    count);
}

}  // namespace

TrueIncrements::TrueIncrements(const Trajectory& trajectory, double rate_hz, double duration_s,
                               int threads)
    : size_(increment_count(trajectory, rate_hz, duration_s)) {
  if (size_ == 0) return;
  const std::size_t stored = repeating(trajectory, rate_hz, size_);
  if (stored > kMostStored) {
    throw Error("IMU increments on '" + trajectory.name + "': " + std::to_string(stored) +
                " to store, at most " + std::to_string(kMostStored) +
                ": lower the IMU rate or the duration");
  }
  stored_.resize(stored);
  parallel_for((stored + kBlock - 1) / kBlock,
               [&](std::size_t block) {
                 const std::size_t end = std::min(stored, (block + 1) * kBlock);
                 for (std::size_t k = block * kBlock; k < end; ++k) {
                   stored_[k] = true_increment(trajectory, static_cast<double>(k) / rate_hz,
                                               static_cast<double>(k + 1) / rate_hz);
                 }
               },
               {}, threads);
  period_ = stored_.back().time.time_since_epoch();
}

}  // namespace leeway::sim
