#include "leeway/sim/analysis/elasticity.hpp"

#include <algorithm>
#include <cmath>

#include "lib/earth/field_walk.hpp"

namespace leeway::sim {
namespace {

constexpr double kLogStep = 0.05;
constexpr double kLeastGrowth = 0.02;
constexpr int kSlopeSteps = 2;  // to each side
const double kSlopeStep = std::log(1.1);

double log_error(const Scene& scene, const ErrorTrack& track) {
  return std::log(analyze(scene, track).true_m);
}

/// d ln E / d ln T by least squares.
double growth_at(const Scene& scene, const ErrorTrack& track) {
  const double log_longest = std::log(0.5 * scene.duration_s);
  const double log_middle =
      std::min(std::log(scene.gnss.interval_s), log_longest - kSlopeSteps * kSlopeStep);
  double above = 0.0;
  double below = 0.0;
  for (int i = -kSlopeSteps; i <= kSlopeSteps; ++i) {
    Scene other = scene;
    other.gnss.interval_s = std::exp(log_middle + i * kSlopeStep);
    above += i * kSlopeStep * log_error(other, track);
    below += i * kSlopeStep * i * kSlopeStep;
  }
  return above / below;
}

}  // namespace

Elasticities elasticities(const Scene& scene, const ErrorTrack& track, double interval_s) {
  validate(scene);
  require("elasticities", "interval_s, at most half the scene,", interval_s,
          between(0.01, 0.5 * scene.duration_s));
  Scene at = scene;
  at.gnss.interval_s = interval_s;
  Elasticities result{interval_s, analyze(at, track).true_m, growth_at(at, track)};
  for (const Specification specification : specifications(at)) {
    const double more = log_error(scaled(at, specification, std::exp(kLogStep)), track);
    const double less = log_error(scaled(at, specification, std::exp(-kLogStep)), track);
    Elasticity next{specification, (more - less) / (2.0 * kLogStep)};
    const bool grows = result.growth > kLeastGrowth;
    next.of_interval = grows ? -next.of_error / result.growth
                             : std::numeric_limits<double>::quiet_NaN();
    result.each.push_back(next);
  }
  std::ranges::stable_sort(result.each, [](const Elasticity& a, const Elasticity& b) {
    return std::abs(a.of_error) > std::abs(b.of_error);
  });
  return result;
}

}  // namespace leeway::sim
