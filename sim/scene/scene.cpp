#include "leeway/sim/scene/scene.hpp"

#include "leeway/earth/error.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway::sim {
namespace {

constexpr double kLevellingGravityMps2 = 9.806;
constexpr double kLeastHeadingRad = 1e-5;
constexpr double kMostHeadingRad = 10.0 * kRadPerDeg;

/// Of the bias at the start, turn-on and in-run together.
double bias_sigma(const TriadErrorModel& triad) {
  return std::hypot(triad.bias_sigma, triad.in_run.sigma);
}

bool is_withheld(const std::vector<Outage>& outages, double t_s) {
  return std::any_of(outages.begin(), outages.end(), [t_s](const Outage& o) {
    return t_s > o.start_s && t_s <= o.start_s + o.duration_s;
  });
}

}  // namespace

void validate(const Scene& scene) {
  if (!scene.trajectory.motion) throw Error("scene: the trajectory has no motion");
  validate_fields("scene", scene);
  validate(scene.gnss.errors);
  require("scene", "duration_s", scene.duration_s, positive_to(scene.trajectory.duration_s));
  const double last_fix_s = std::max(scene.duration_s - scene.gnss.latency_s, 0.0);
  require("scene", "gnss.settle_s", scene.gnss.settle_s, between(0.0, last_fix_s));
}

void set_imu(Scene& scene, const std::string& name, const ImuErrorModel& model) {
  scene.imu_name = name;
  scene.imu = model;
  scene.filter.imu = model;
}

InitialSigma initial_sigma(const Scene& scene) {
  if (scene.initial) return *scene.initial;
  const double earth_rate_radps =
      wgs84::kRotationRateRadps * std::cos(scene.trajectory.plane.origin.lat_rad);
  InitialSigma sigma;
  sigma.tilt_rad = bias_sigma(scene.imu.accelerometer) / kLevellingGravityMps2;
  sigma.heading_rad =
      std::clamp(bias_sigma(scene.imu.gyro) / earth_rate_radps, kLeastHeadingRad, kMostHeadingRad);
  sigma.velocity_mps = scene.gnss.errors.velocity_sigma_n_mps.maxCoeff();
  sigma.position_m = std::hypot(scene.gnss.errors.position_sigma_n_m.head<2>().maxCoeff(),
                                scene.gnss.errors.correlated_sigma_n_m.head<2>().maxCoeff());
  return sigma;
}

double repeating_part_s(const Scene& scene) {
  return std::max(
      {scene.limit.last_s, 2.0 * scene.gnss.interval_s, scene.trajectory.period_s.value_or(0.0)});
}

double scored_part_s(const Scene& scene) {
  const GnssScenario& gnss = scene.gnss;
  if (gnss.settle_s == 0.0) return repeating_part_s(scene);
  // Between the arrivals of the last fix of those that settle the filter and of the next one.
  return scene.duration_s - gnss.settle_s - gnss.latency_s - 0.5 * gnss.interval_s;
}

double longest_interval_s(const Scene& scene) {
  constexpr double kRounding = 1e-9;  // of times that are sums
  const double settled_s = scene.duration_s - scene.gnss.settle_s - scene.gnss.latency_s;
  return std::min(0.5 * scene.duration_s, (1.0 - kRounding) * settled_s);
}

NavigatorConfig navigator_config(const Scene& scene) {
  NavigatorConfig config;
  config.filter = scene.filter;
  if (scene.vehicle) config.vehicle = scene.vehicle->config;
  config.timing.max_imu_rate_hz = std::max(config.timing.max_imu_rate_hz, scene.imu_rate_hz);
  config.timing.max_lateness_s = std::max(config.timing.max_lateness_s, scene.gnss.latency_s);
  return config;
}

std::vector<double> fix_times_s(const GnssScenario& gnss, double duration_s) {
  std::vector<double> times_s;
  const auto add_until = [&](double end_s, double from_s, double interval_s) {
    for (std::int64_t k = 1;; ++k) {
      const double t_s = from_s + static_cast<double>(k) * interval_s;
      if (t_s > end_s * (1.0 + 1e-12)) return;
      if (!is_withheld(gnss.outages, t_s)) times_s.push_back(std::min(t_s, end_s));
    }
  };
  add_until(std::min(gnss.settle_s, duration_s), 0.0, gnss.settle_interval_s);
  add_until(duration_s, gnss.settle_s, gnss.interval_s);
  return times_s;
}

}  // namespace leeway::sim
