#include "sim/atlas/mismatch/scene_claims.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "leeway/model/horizontal.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/tools/parallel.hpp"
#include "leeway/sim/tools/quantile.hpp"

namespace leeway::sim {
namespace {

constexpr std::array kVehicles{VehicleKind::kNone, VehicleKind::kCar};
constexpr std::array kFixIntervalsS{1, 5, 10, 20};

/// Fixes every second, and only every T-th of them once they are few.
Scene thinned(Scene scene, int fix_interval_s) {
  scene.gnss.interval_s = 1.0;
  scene.gnss.outages.clear();
  if (fix_interval_s == 1) return scene;
  for (double from_s = kDenseS; from_s < scene.duration_s; from_s += fix_interval_s) {
    // Half a second from the fixes on either side.
    scene.gnss.outages.push_back({from_s + 0.5, fix_interval_s - 1.0});
  }
  return scene;
}

/// R95 of the linear analysis, m, by the epoch at which a fix arrives.
using LinearR95 = std::map<long, double>;

LinearR95 linear_r95(const Scene& scene, const ErrorTrack& track) {
  LinearR95 r95_m;
  CovarianceConfig config;
  config.observer = [&](const CovariancePoint& point) {
    if (point.moment != CovariancePoint::Moment::kBeforeFix || point.t_s <= kDenseS) return;
    const auto P = horizontal_covariance(point.r_e_m, point.truth.block<3, 3>(kDr, kDr));
    r95_m[epoch_at(point.t_s)] = horizontal_radius_m(P, 0.95);
  };
  analyze(scene, track, config);
  return r95_m;
}

/// What all trials share.
struct Town {
  Scene scene{};  ///< a fix every second
  TrueDrive way{};
  std::vector<LinearR95> linear{};  ///< by kFixIntervalsS
};

Town town_of(const Scene& scene) {
  Town town{.scene = thinned(scene, 1)};
  // The linear analysis is that of fixes alone, whatever the vehicle tells.
  town.scene.estimator = SceneEstimator::kEkf;
  town.scene.vehicle.reset();
  town.scene.gnss.settle_s = 0.0;
  town.scene.duration_s = kDenseS + kSparseS;
  town.way = true_drive(scene.trajectory, scene.imu_rate_hz, town.scene.duration_s);
  const ErrorTrack track = error_track(town.scene);
  for (const int t_s : kFixIntervalsS) {
    town.linear.push_back(linear_r95(thinned(town.scene, t_s), track));
  }
  return town;
}

/// A run, and its errors before fixes, m, and over the linear R95.
struct SceneTrial {
  ClaimScore score{};
  std::vector<double> errors_m{};
  std::vector<double> over_linear{};
};

SceneTrial run_scene_trial(const Town& town, const FaultInputs& inputs, VehicleKind vehicle,
                           std::size_t interval) {
  NavigatorConfig config;
  config.filter.lever_arm_b_m = town.scene.filter.lever_arm_b_m;
  config.vehicle = VehicleConfig::of(vehicle);
  SceneTrial trial;
  trial.score =
      run_claims(config, inputs, town.way, kFixIntervalsS[interval], [&](const FaultEpoch& epoch) {
        const double r95_m = town.linear[interval].at(epoch_at(epoch.t_s));
        trial.errors_m.push_back(epoch.horizontal_m());
        trial.over_linear.push_back(epoch.horizontal_m() / r95_m);
      });
  return trial;
}

/// By vehicle, then interval.
std::vector<SceneTrial> run_seed(const Town& town, std::uint64_t seed) {
  const Scene& scene = town.scene;
  const FaultInputs inputs =
      inputs_of(town.way, scene.imu, scene.gnss, scene.gnss.interval_s, seed);
  std::vector<SceneTrial> trials;
  for (const VehicleKind vehicle : kVehicles) {
    for (std::size_t i = 0; i < kFixIntervalsS.size(); ++i) {
      trials.push_back(run_scene_trial(town, inputs, vehicle, i));
    }
  }
  return trials;
}

/// @param trials  by seed, then vehicle and interval; of the cell-th of these
SceneClaim summed(const std::vector<std::vector<SceneTrial>>& trials, std::size_t cell) {
  SceneClaim claim{.vehicle = kVehicles[cell / kFixIntervalsS.size()],
                   .fix_interval_s = kFixIntervalsS[cell % kFixIntervalsS.size()]};
  std::vector<double> errors_m;
  std::vector<double> over_linear;
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const SceneTrial& trial = trials[k][cell];
    claim.before_fixes.add(trial.score.before_fixes);
    claim.between.add(trial.score.between);
    if (trial.score.lost) claim.lost.push_back(k + 1);
    errors_m.insert(errors_m.end(), trial.errors_m.begin(), trial.errors_m.end());
    over_linear.insert(over_linear.end(), trial.over_linear.begin(), trial.over_linear.end());
  }
  claim.r95_m = quantile_of(std::move(errors_m), 0.95);
  claim.r95_over_linear = quantile_of(std::move(over_linear), 0.95);
  return claim;
}

}  // namespace

std::vector<SceneClaim> run_scene_claims(const Scene& scene, int trials, int threads,
                                         const std::function<void(double fraction)>& progress) {
  const Town town = town_of(scene);
  std::vector<std::vector<SceneTrial>> results(static_cast<std::size_t>(trials));
  const auto show = [&](std::size_t done) {
    if (progress) progress(static_cast<double>(done) / static_cast<double>(trials));
  };
  parallel_for(
      results.size(), [&](std::size_t k) { results[k] = run_seed(town, k + 1); }, show, threads);
  std::vector<SceneClaim> claims;
  for (std::size_t cell = 0; cell < results.front().size(); ++cell) {
    claims.push_back(summed(results, cell));
  }
  return claims;
}

}  // namespace leeway::sim
