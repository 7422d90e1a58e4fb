#include "leeway/sim/analysis/elasticity.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "leeway/sim/tools/parallel.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway::sim {
namespace {

constexpr double kLogStep = 0.05;
constexpr double kLeastGrowth = 0.02;
constexpr int kSlopeSteps = 2;  // to each side
const double kSlopeStep = std::log(1.1);

/// The scene at intervals on both sides of its own, none longer than longest_interval_s().
std::vector<Scene> at_other_intervals(const Scene& scene) {
  const double log_longest = std::log(longest_interval_s(scene)) - kSlopeSteps * kSlopeStep;
  const double log_middle = std::min(std::log(scene.gnss.interval_s), log_longest);
  std::vector<Scene> scenes(2 * kSlopeSteps + 1, scene);
  for (int i = -kSlopeSteps; i <= kSlopeSteps; ++i) {
    Scene& other = scenes[static_cast<std::size_t>(i + kSlopeSteps)];
    other.gnss.interval_s = std::exp(log_middle + i * kSlopeStep);
  }
  return scenes;
}

/// d ln E / d ln T by least squares, from the log(error) of these scenes.
double slope(std::span<const double> log_errors) {
  double above = 0.0;
  double below = 0.0;
  for (int i = -kSlopeSteps; i <= kSlopeSteps; ++i) {
    above += i * kSlopeStep * log_errors[static_cast<std::size_t>(i + kSlopeSteps)];
    below += i * kSlopeStep * i * kSlopeStep;
  }
  return above / below;
}

}  // namespace

Elasticities elasticities(const Scene& scene, const ErrorTrack& track, double interval_s) {
  validate(scene);
  require("elasticities", "interval_s", interval_s, between(0.01, longest_interval_s(scene)));
  Scene at = scene;
  at.gnss.interval_s = interval_s;
  const std::vector<Specification> all = specifications(at);
  std::vector<Scene> scenes = at_other_intervals(at);
  const std::size_t slopes = scenes.size();
  for (const Specification specification : all) {
    scenes.push_back(scaled(at, specification, std::exp(kLogStep)));
    scenes.push_back(scaled(at, specification, std::exp(-kLogStep)));
  }
  scenes.push_back(at);
  std::vector<double> log_errors(scenes.size());
  double error_m = 0.0;
  const auto find_error = [&](std::size_t i) {
    const CovarianceAnalysis analysis = analyze(scenes[i], track);
    log_errors[i] = std::log(analysis.true_m / analysis.allowed_m);
    if (i + 1 == scenes.size()) error_m = analysis.true_m;
  };
  parallel_for(scenes.size(), find_error);
  Elasticities result{interval_s, error_m, slope(std::span(log_errors).first(slopes))};
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double* const pair = &log_errors[slopes + 2 * i];
    Elasticity next{all[i], (pair[0] - pair[1]) / (2.0 * kLogStep)};
    const bool grows = result.growth > kLeastGrowth;
    next.of_interval =
        grows ? -next.of_error / result.growth : std::numeric_limits<double>::quiet_NaN();
    result.each.push_back(next);
  }
  std::ranges::stable_sort(result.each, [](const Elasticity& a, const Elasticity& b) {
    return std::abs(a.of_error) > std::abs(b.of_error);
  });
  return result;
}

}  // namespace leeway::sim
