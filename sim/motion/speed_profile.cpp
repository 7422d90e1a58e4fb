#include "sim/motion/speed_profile.hpp"

#include <algorithm>
#include <cmath>

#include "sim/motion/smooth_step.hpp"

namespace leeway::sim {
namespace {

/// Lowers the speeds of the nodes to what can be reached from one to the next and braked to.
void make_reachable(std::vector<SpeedNode>& nodes, double acceleration_mps2) {
  const auto limit = [acceleration_mps2](const SpeedNode& from, SpeedNode& to) {
    const double distance_m = std::abs(to.s_m - from.s_m);
    const double reachable_mps =
        std::sqrt(from.speed_mps * from.speed_mps + 2.0 * acceleration_mps2 * distance_m);
    to.speed_mps = std::min(to.speed_mps, reachable_mps);
  };
  for (std::size_t k = 1; k < nodes.size(); ++k) limit(nodes[k - 1], nodes[k]);
  for (std::size_t k = nodes.size() - 1; k > 0; --k) limit(nodes[k], nodes[k - 1]);
}

}  // namespace

SpeedProfile::SpeedProfile(std::vector<SpeedNode> nodes, double acceleration_mps2, bool loop)
    : smooth_acceleration_mps2_(acceleration_mps2 / kSmoothStepMaxSlope) {
  make_reachable(nodes, smooth_acceleration_mps2_);
  if (loop) {
    // The slower of both ends is the speed there. Once more: what it slows the others by.
    nodes.front().speed_mps = std::min(nodes.front().speed_mps, nodes.back().speed_mps);
    nodes.back().speed_mps = nodes.front().speed_mps;
    make_reachable(nodes, smooth_acceleration_mps2_);
    nodes.back().rest_s = 0.0;
  }
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    add(nodes[k].rest_s, 0.0, 0.0);
    if (k + 1 < nodes.size()) add_section(nodes[k], nodes[k + 1]);
  }
}

void SpeedProfile::add(double length_s, double from_mps, double to_mps) {
  if (!(length_s > 0.0)) return;
  ramps_.push_back({duration_s_, length_s, end_m_, from_mps, to_mps});
  duration_s_ += length_s;
  end_m_ += 0.5 * (from_mps + to_mps) * length_s;
}

void SpeedProfile::add_change(double from_mps, double to_mps) {
  add(std::abs(to_mps - from_mps) / smooth_acceleration_mps2_, from_mps, to_mps);
}

void SpeedProfile::add_section(const SpeedNode& from, const SpeedNode& to) {
  const double length_m = to.s_m - from.s_m;
  const double v0_sq = from.speed_mps * from.speed_mps;
  const double v1_sq = to.speed_mps * to.speed_mps;
  const double reachable_mps =
      std::sqrt(0.5 * (v0_sq + v1_sq) + smooth_acceleration_mps2_ * length_m);
  const double top_mps = std::min(from.speed_after_mps, reachable_mps);
  const double changing_m =
      (2.0 * top_mps * top_mps - v0_sq - v1_sq) / (2.0 * smooth_acceleration_mps2_);
  end_m_ = from.s_m;  // nothing accumulates
  add_change(from.speed_mps, top_mps);
  add((length_m - changing_m) / top_mps, top_mps, top_mps);
  add_change(top_mps, to.speed_mps);
  end_m_ = to.s_m;
}

Jet SpeedProfile::distance_m(double t_s) const {
  if (t_s >= duration_s_) {
    const double end_mps = ramps_.back().to_mps;
    return {end_m_, end_mps, 0.0};
  }
  const auto after = std::upper_bound(ramps_.begin(), ramps_.end(), t_s,
                                      [](double t, const Ramp& r) { return t < r.start_s; });
  const Ramp& ramp = *std::prev(after);
  const Jet since_s = time_jet(t_s) - ramp.start_s;
  const Jet changed_m =
      (ramp.to_mps - ramp.from_mps) * ramp.length_s * smooth_step_integral(since_s / ramp.length_s);
  return ramp.start_m + ramp.from_mps * since_s + changed_m;
}

std::vector<double> SpeedProfile::breaks_s() const {
  std::vector<double> breaks_s;
  for (std::size_t k = 1; k < ramps_.size(); ++k) breaks_s.push_back(ramps_[k].start_s);
  return breaks_s;
}

}  // namespace leeway::sim
