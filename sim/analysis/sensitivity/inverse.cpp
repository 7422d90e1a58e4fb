#include "leeway/sim/analysis/inverse.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/sim/sensors/imu_catalogue.hpp"
#include "leeway/sim/sensors/imu_class_name.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "lib/earth/field_walk.hpp"
#include "sim/analysis/sensitivity/candidate_tracks.hpp"
#include "sim/analysis/sensitivity/factor_search.hpp"

namespace leeway::sim {
namespace {

/// The questions that are asked of a scene: each specification of the IMU alone, then those that
/// come together.
std::vector<NeededFactor> groups_of(const Scene& scene) {
  std::vector<NeededFactor> groups;
  NeededFactor accelerometer{"accelerometer"};
  NeededFactor gyro{"gyro"};
  NeededFactor imu{"imu"};
  NeededFactor receiver{"receiver"};
  for (const Specification specification : specifications(scene)) {
    if (is_of_imu(specification)) {
      groups.push_back({std::string(name(specification)), {specification}});
      imu.what.push_back(specification);
      const bool is_gyro = specification >= Specification::kGyroBias;
      (is_gyro ? gyro : accelerometer).what.push_back(specification);
    } else if (specification <= Specification::kGnssVelocity) {
      receiver.what.push_back(specification);
    }
  }
  for (NeededFactor* together : {&accelerometer, &gyro, &imu, &receiver}) {
    if (!together->what.empty()) groups.push_back(std::move(*together));
  }
  return groups;
}

/// The scene with every IMU that there is to choose from.
std::vector<Scene> candidate_scenes(const Scene& scene, BiasModel class_bias) {
  std::vector<Scene> scenes;
  const auto add = [&](const std::string& imu, const ImuErrorModel& model) {
    scenes.push_back(scene);
    set_imu(scenes.back(), imu, model);
  };
  for (const ImuClass c : kAll<ImuClass>) {
    for (const RangeEnd end : kAll<RangeEnd>) {
      add(imu_name({c, end}), with_bias_model(imu_class_model(c, end), class_bias));
    }
  }
  for (const ImuPart& part : imu_parts()) add(std::string(part.name), imu_model(part));
  return scenes;
}

std::vector<ImuCandidate> candidates_of(const Scene& scene, double limit_m,
                                        const InverseConfig& config) {
  const std::vector<Scene> scenes = candidate_scenes(scene, config.class_bias);
  CandidateTracks tracks(config.covariance_step_s);
  std::vector<const ErrorTrack*> track_of;
  for (const Scene& candidate : scenes) track_of.push_back(&tracks.of(candidate));
  std::vector<ImuCandidate> candidates(scenes.size());
  const auto judge = [&](std::size_t i) {
    const double error_m = analyze(scenes[i], *track_of[i]).true_m;
    const bool is_class = i < kAll<ImuClass>.size() * kAll<RangeEnd>.size();
    candidates[i] = {scenes[i].imu_name, is_class, error_m, error_m <= limit_m};
  };
  parallel_for(scenes.size(), judge, {}, config.threads);
  std::ranges::stable_sort(candidates, {}, &ImuCandidate::error_m);
  return candidates;
}

}  // namespace

Scene with_factor(Scene scene, const std::vector<Specification>& what, double factor) {
  for (const Specification specification : what) {
    scene = scaled(std::move(scene), specification, factor);
  }
  return scene;
}

Inverse invert(const Scene& scene, double interval_s, double limit_m, const InverseConfig& config) {
  validate(scene);
  require("inverse", "interval_s", interval_s, between(0.01, longest_interval_s(scene)));
  require("inverse", "limit_m", limit_m, positive_to(1e6));
  Scene at = scene;
  at.gnss.interval_s = interval_s;
  const ErrorTrack track = error_track(at, config.covariance_step_s);
  CovarianceConfig by_source;
  by_source.by_source = true;
  const CovarianceAnalysis own = analyze(at, track, by_source);
  Inverse inverse{interval_s, limit_m, own.true_m, own.error_budget, groups_of(at)};
  const FactorQuestion question{at, track, own, limit_m, config.tolerance};
  const auto answer = [&](std::size_t i) {
    NeededFactor& group = inverse.factors[i];
    group = needed_factor(question, group.name, group.what);
  };
  parallel_for(inverse.factors.size(), answer, {}, config.threads);
  inverse.candidates = candidates_of(at, limit_m, config);
  return inverse;
}

}  // namespace leeway::sim
