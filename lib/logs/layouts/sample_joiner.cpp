#include "lib/logs/layouts/sample_joiner.hpp"

#include <chrono>

namespace leeway {
namespace {

// Of one series while the other is silent: some seconds of the fastest sensors.
constexpr std::size_t kMostWaiting = 4096;
constexpr Duration kLongestForceGap = std::chrono::milliseconds{500};

}  // namespace

void SampleJoiner::add(std::deque<Vector>& series, const Vector& vector) {
  if (!series.empty() && vector.time <= series.back().time) return;
  if (series.size() == kMostWaiting) series.pop_front();
  series.push_back(vector);
}

bool SampleJoiner::has_next() {
  while (!rates_.empty() && !forces_.empty() && forces_.back().time >= rates_.front().time) {
    const Time time = rates_.front().time;
    while (forces_.size() > 1 && forces_[1].time <= time) forces_.pop_front();
    const bool is_there = forces_[0].time == time;
    const bool is_between = forces_[0].time < time && forces_.size() > 1 &&
                            forces_[1].time - forces_[0].time <= kLongestForceGap;
    if (is_there || is_between) return true;
    rates_.pop_front();
  }
  return false;
}

ImuRow SampleJoiner::next() {
  const Vector rate = rates_.front();
  rates_.pop_front();
  Eigen::Vector3d force = forces_[0].value;
  if (forces_[0].time < rate.time) {
    const double part =
        to_seconds(rate.time - forces_[0].time) / to_seconds(forces_[1].time - forces_[0].time);
    force += part * (forces_[1].value - force);
  }
  return {.time = rate.time, .angular = rate.value, .linear = force, .is_rate = true};
}

bool SampleJoiner::needs_force() const {
  if (rates_.empty()) return false;
  return forces_.empty() || forces_.back().time < rates_.front().time;
}

}  // namespace leeway
