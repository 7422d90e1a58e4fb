#include "sim/atlas/crossing.hpp"

#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/waypoints.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "sim/atlas/free_run.hpp"
#include "sim/atlas/ned_mechanization.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim {
namespace {

constexpr double kCrossingMps = 250.0;

std::vector<ImuIncrement> crossing_increments(const Scene& scene) {
  return true_increments(scene.trajectory, scene.imu_rate_hz, scene.duration_s);
}

double position_rms_m(WatchedFilter& filter, const RecordedTrial& trial) {
  return errors_after(filter, trial, 0.0).position_rms_m();
}

}  // namespace

Scene crossing(const Geodetic& from, const Geodetic& to) {
  Scene scene;
  scene.name = "crossing";
  scene.trajectory =
      waypoint_trajectory({.waypoints = {{from, kCrossingMps, {}}, {to, kCrossingMps, {}}}});
  scene.duration_s = std::floor(scene.trajectory.duration_s);
  set_imu(scene, "tactical", imu_class_model(ImuClass::kTactical, RangeEnd::kMid));
  scene.filter.gnss_correlation_s = 0.0;
  scene.initial =
      InitialSigma{.tilt_rad = 3e-3, .heading_rad = 0.02, .velocity_mps = 0.1, .position_m = 3.0};
  return scene;
}

std::vector<AtlasCell> crossed_without_fixes(const Scene& scene, const std::string& condition) {
  const auto increments = crossing_increments(scene);
  const NavState start = truth_at(scene.trajectory, 0.0).nav;
  const NavState truth = truth_at(scene.trajectory, to_seconds(increments.back().time)).nav;
  std::vector<AtlasCell> cells;
  for (const Scheme scheme :
       {Scheme::kExplicitEuler, Scheme::kOneSample, Scheme::kTwoSample, Scheme::kRungeKutta4}) {
    const FreeRun run = free_run(start, increments, {scheme});
    cells.push_back({AtlasGroup::kStrapdown, std::string(name(scheme)), condition,
                     (truth.r_e_m - run.nav.r_e_m).norm(), run.reported});
  }
  return cells;
}

std::vector<AtlasCell> crossed_with_fixes(const Scene& scene, const std::string& condition,
                                          int trials) {
  return scored(few_atlas_columns(), scene.filter, recorded_trials(scene, trials), condition,
                position_rms_m);
}

AtlasCell crossed_in_latitude_and_longitude(const Scene& scene, const std::string& condition,
                                            double share) {
  const auto increments = crossing_increments(scene);
  const auto truth = [&](const ImuIncrement& inc) {
    return truth_at(scene.trajectory, to_seconds(inc.time)).nav.r_e_m;
  };
  NedMechanization ned(truth_at(scene.trajectory, 0.0).nav);
  for (const ImuIncrement& inc : increments) {
    ned.push(inc);
    const bool is_fix = inc.time.time_since_epoch() % std::chrono::seconds{1} == Duration{};
    if (is_fix && share > 0.0) ned.correct(geodetic_from_ecef(truth(inc)), share);
  }
  return {AtlasGroup::kNotOffered,
          share > 0.0 ? "latitude and longitude/blended with fixes" : "latitude and longitude",
          condition,
          (truth(increments.back()) - ned.r_e_m()).norm(),
          {}};
}

AtlasLimits crossing_limits() {
  return {10.0, 100.0,
          "fixes of 2.5 m leave some metres; at a hundred an approach to a runway is lost"};
}

}  // namespace leeway::sim
