#include "lib/logs/messages/sensor_clock.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace leeway {
namespace {

constexpr std::int64_t kHalf24Bits = std::int64_t{1} << 23;
constexpr int kEpochMemory = 64;
// Between an epoch and where the line has it: else a clock has started again.
constexpr double kMostEpochErrorS = 2.0;
// No oscillator of a sensor is off by more.
constexpr double kMostClockRate = 0.05;

}  // namespace

std::int64_t CountUnroller::unroll(std::uint32_t count) {
  if (last_ && std::int64_t{count} - *last_ < -kHalf24Bits) {
    const bool has_24_bits = *last_ < 2 * kHalf24Bits;
    offset_ += has_24_bits ? 2 * kHalf24Bits : std::int64_t{1} << 32;
  }
  last_ = count;
  return offset_ + count;
}

void SensorClock::learn(Time epoch, Time newest) {
  const auto expected = gps_time_of(newest);
  const double error_s = expected ? to_seconds(epoch - *expected) : 0.0;
  if (!expected || std::abs(error_s) > kMostEpochErrorS) {
    *this = SensorClock{};
    epochs_ = 1;
    own_ = newest;
    gps_ = epoch;
    return;
  }
  const double step_s = to_seconds(newest - own_);
  if (step_s <= 0.0) return;
  // Gains of a line through k points, which then fade: k is held.
  epochs_ = std::min(epochs_ + 1, kEpochMemory);
  const double k = epochs_;
  const double of_offset = 2.0 * (2.0 * k - 1.0) / (k * (k + 1.0));
  const double of_rate = 6.0 / (k * (k + 1.0));
  gps_ = *expected + duration_from_seconds(of_offset * error_s);
  own_ = newest;
  rate_ = std::clamp(rate_ + of_rate * error_s / step_s, -kMostClockRate, kMostClockRate);
}

std::optional<Time> SensorClock::gps_time_of(Time own) const {
  if (epochs_ == 0) return std::nullopt;
  const double since_s = to_seconds(own - own_);
  if (std::abs(since_s) > 1e6) return std::nullopt;
  return gps_ + (own - own_) + duration_from_seconds(rate_ * since_s);
}

}  // namespace leeway
