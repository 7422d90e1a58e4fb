#include "leeway/sim/analysis/elasticity.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "leeway/earth/error.hpp"
#include "leeway/sim/analysis/interval.hpp"
#include "leeway/sim/motion/trajectories.hpp"

namespace leeway::sim {
namespace {

Scene scene_at_rest() {
  Scene scene;
  scene.name = "at rest";
  scene.trajectory = static_trajectory({.duration_s = 3600.0});
  scene.duration_s = 3600.0;
  set_imu(scene, "tactical/mid", imu_class_model(ImuClass::kTactical, RangeEnd::kMid));
  scene.filter.gnss_correlation_s = 0.0;
  return scene;
}

}  // namespace

TEST_CASE("elasticity: as an interval solved again for 10 % better and worse specifications") {
  const Scene scene = scene_at_rest();
  for (const double limit_m : {3.0, 30.0}) {
    CAPTURE(limit_m);
    const double own_s = solve_intervals(scene, {limit_m}).front().interval_s;
    const Elasticities found = elasticities(scene, error_track(scene), own_s);
    CHECK(found.each.size() == 6);
    const auto solved_s = [&](Specification specification, double factor) {
      const Scene other = scaled(scene, specification, factor);
      return solve_intervals(other, {limit_m}).front().interval_s;
    };
    for (const Elasticity& e : found.each) {
      CAPTURE(name(e.specification));
      const double better = std::log(solved_s(e.specification, 1.0 / 1.1) / own_s) / -std::log(1.1);
      const double worse = std::log(solved_s(e.specification, 1.1) / own_s) / std::log(1.1);
      // 0.1 % of the interval over 10 % of the specification; the curve bends by a few percent.
      CHECK(std::abs(e.of_interval - 0.5 * (better + worse)) < 0.015);
      CHECK(std::abs(e.of_interval - better) < 0.025);
    }
  }
}

TEST_CASE("elasticity: where the filter knows all, errors of all sources add up to one") {
  // The error is linear in all sigmas together, and gains that are the best change it to second
  // order only: each elasticity is the source's share of the mean square.
  const Scene scene = scene_at_rest();
  const ErrorTrack track = error_track(scene);
  Scene at = scene;
  at.gnss.interval_s = 60.0;
  CovarianceConfig by_source;
  by_source.by_source = true;
  const CovarianceAnalysis analysis = analyze(at, track, by_source);
  const double all_m2 = analysis.true_m * analysis.true_m;  // DRMS
  double sum = 0.0;
  for (const Elasticity& e : elasticities(scene, track, 60.0).each) {
    CAPTURE(name(e.specification));
    sum += e.of_error;
    double share = 0.0;
    for (const ErrorBudgetLine& line : analysis.error_budget) {
      if (line.source != source_of(e.specification)) continue;
      share += (line.mean_sq_n_m2(0, 0) + line.mean_sq_n_m2(1, 1)) / all_m2;
    }
    CHECK(std::abs(e.of_error - share) < 0.01);
  }
  CHECK(std::abs(sum - 1.0) < 0.01);
}

TEST_CASE("elasticity: where the limit grows with the way, as an interval solved again") {
  Scene scene = scene_at_rest();
  scene.trajectory = straight({.duration_s = 3600.0});
  const AllowedError allowed{3.0, 0.002};
  scene.limit.allow(allowed);
  const Specification noise = Specification::kGyroNoise;
  const double own_s = solve_intervals(scene, {allowed}).front().interval_s;
  const auto solved_s = [&](double factor) {
    return solve_intervals(scaled(scene, noise, factor), {allowed}).front().interval_s;
  };
  const double again = std::log(solved_s(1.1) / solved_s(1.0 / 1.1)) / (2.0 * std::log(1.1));
  for (const Elasticity& e : elasticities(scene, error_track(scene), own_s).each) {
    if (e.specification == noise) CHECK(std::abs(e.of_interval - again) < 0.02);
  }
}

TEST_CASE("elasticity: the largest comes first, and wrong intervals are refused") {
  const Scene scene = scene_at_rest();
  const ErrorTrack track = error_track(scene);
  const Elasticities found = elasticities(scene, track, 200.0);
  CHECK(found.each.front().specification == Specification::kGyroNoise);
  CHECK(found.growth > 2.0);
  CHECK(found.growth < 2.6);
  CHECK_THROWS_WITH_AS(elasticities(scene, track, 0.0), doctest::Contains("0.01 to 1800"), Error);
  CHECK_THROWS_AS(elasticities(scene, track, 1801.0), Error);
}

}  // namespace leeway::sim
