#include "sim/analysis/doubling/stretch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "leeway/covariance/covariance.hpp"
#include "sim/analysis/truth_model.hpp"

namespace leeway::sim {
namespace {

constexpr std::size_t kMostLevels = 12;
constexpr std::size_t kLeastSteady = 2;  // level of what is kept of steady motion
constexpr std::size_t kMostBytes = 4'000'000;

/// Phi P Phi^T.
ErrorMatrix carried(ErrorMatrix P, const Transition& Phi) {
  propagate(P, Phi, ProcessNoise{});
  return P;
}

ErrorMatrix noise_over(const Transition& Phi, const ProcessNoise& noise) {
  ErrorMatrix P = ErrorMatrix::Zero();
  propagate(P, Phi, noise);
  return P;
}

}  // namespace

Stretch joined(const Stretch& earlier, const Stretch& later) {
  Stretch both;
  both.Phi = compose(later.Phi, earlier.Phi);
  both.claimed_noise = carried(earlier.claimed_noise, later.Phi) + later.claimed_noise;
  both.true_noise = carried(earlier.true_noise, later.Phi) + later.true_noise;
  if (earlier.B.size() > 0) both.B = times(later.Phi, ParameterMatrix(earlier.B)) + later.B;
  return both;
}

Stretches::Stretches(const Scene& scene, const ErrorTrack& track)
    : scene_(scene),
      track_(track),
      claimed_(process_noise(scene.filter.imu, scene.filter.biases)),
      true_(TruthModel<1>(scene, ErrorMatrix::Zero(), std::array{claimed_}, false).white_noise()) {
  const std::size_t steps = track.steps();
  for (std::size_t level = 0; level < kMostLevels && (steps >> level) > 0; ++level) {
    kept_.emplace_back(steps >> level, 0);
  }
  while ((2 * steps >> lowest_level_) * sizeof(Stretch) > kMostBytes) ++lowest_level_;
}

Stretch Stretches::between(double from_s, double to_s) {
  std::optional<Stretch> all;
  const auto add = [&all](const Stretch& next) { all = all ? joined(*all, next) : next; };
  struct Adder {
    const Stretches& stretches;
    decltype(add)& add_next;
    void operator()(const Stretch& next) const { add_next(next); }
    void operator()(const Leg& next) const { add_next(stretches.of(next)); }
  };
  follow_parts(from_s, to_s, Adder{*this, add});
  return all.value_or(Stretch{});
}

const Stretch* Stretches::again(double from_s, double to_s) {
  const double step_s = track_.step_s();
  const auto first = static_cast<std::size_t>(from_s / step_s + kSlack);
  const auto end = static_cast<std::size_t>(std::ceil(to_s / step_s - kSlack));
  if (end < first + 2) return nullptr;
  const std::size_t local = first % track_.steps();
  const std::size_t last = local + (end - first) - 1;
  const std::size_t run = track_.run_of(local);
  if (last >= track_.steps() || run != track_.run_of(last)) return nullptr;
  const double dt_s = to_s - from_s;
  if (run != repeated_.run || std::abs(dt_s - repeated_.dt_s) > kSlack * step_s) {
    repeated_.run = run;
    repeated_.dt_s = dt_s;
    repeated_.times = 1;
    return nullptr;
  }
  if (++repeated_.times == 2) repeated_.stretch = between(from_s, to_s);
  return &repeated_.stretch;
}

const Stretch* Stretches::longest(std::size_t& step, std::size_t last) {
  const std::size_t local = step % track_.steps();
  const std::size_t end = std::min(local + (last - step), track_.steps());
  const auto fits = [&](std::size_t level) {
    const std::size_t legs = std::size_t{1} << level;
    return level < kept_.size() && local % legs == 0 && local + legs <= end;
  };
  std::size_t level = 0;
  while (fits(level + 1)) ++level;
  if (level < lowest_level_) {
    while (level >= kLeastSteady && !is_steady(level, local >> level)) --level;
    if (level < kLeastSteady) return nullptr;
  }
  step += std::size_t{1} << level;
  return &node(level, local >> level);
}

bool Stretches::is_steady(std::size_t level, std::size_t index) const {
  const std::size_t first = index << level;
  const std::size_t last = first + (std::size_t{1} << level) - 1;
  return track_.run_of(first) == track_.run_of(last);
}

const Stretch& Stretches::node(std::size_t level, std::size_t index) {
  std::uint32_t& place = kept_[level][index];
  if (place > 0) return nodes_[place - 1];
  std::uint32_t* shared = nullptr;
  if (is_steady(level, index)) {
    shared = &steady_[{track_.run_of(index << level), level}];
    if (*shared > 0) return nodes_[(place = *shared) - 1];
  }
  nodes_.push_back(made(level, index));
  place = static_cast<std::uint32_t>(nodes_.size());
  if (shared != nullptr) *shared = place;
  return nodes_.back();
}

Stretch Stretches::made(std::size_t level, std::size_t index) {
  if (level == 0) {
    const double from_s = static_cast<double>(index) * track_.step_s();
    return of(track_.leg(from_s, from_s + track_.step_s()));
  }
  const auto half = [&](std::size_t which) {
    const std::size_t child = 2 * index + which;
    const bool is_long = level > kLeastSteady && is_steady(level - 1, child);
    const bool is_kept = level - 1 >= lowest_level_ || is_long;
    return is_kept ? node(level - 1, child) : made(level - 1, child);
  };
  const Stretch earlier = half(0);
  return joined(earlier, half(1));
}

Stretch Stretches::of(const Leg& leg) const {
  Stretch stretch;
  stretch.Phi = leg.Phi;
  stretch.claimed_noise = noise_over(leg.Phi, with_motion(claimed_, scene_.filter.imu, leg.motion));
  stretch.true_noise = noise_over(leg.Phi, true_);
  if (track_.has_parameters()) stretch.B = leg.B;
  return stretch;
}

}  // namespace leeway::sim
