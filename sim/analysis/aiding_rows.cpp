#include "sim/analysis/aiding_rows.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/navigator/aidings.hpp"

namespace leeway::sim {
namespace {

constexpr double kBlockS = 0.5;  // of the navigator's constraints
constexpr double kStillMps = 1e-3;

bool is_still(const Trajectory& trajectory, double t_s) {
  return truth_at(trajectory, std::max(t_s, 0.0)).nav.v_e_mps.norm() < kStillMps;
}

/// What all rows of a step share.
struct Step {
  double dt_s;
  TruthPoint truth;
  Estimate estimate;
  std::vector<AidingRow> rows{};

  /// Adds a measurement that comes every interval_s and is told with the variance m.R.
  /// @param seconds  the time over which the noise of a true reading is that of the kind
  void add(RowKind kind, const Measurement& m, double interval_s, double seconds, Held held) {
    for (int i = 0; i < m.rows(); ++i) {
      AidingRow row{kind};
      const double per_sigma = std::sqrt(dt_s / interval_s / m.R(i, i));
      row.h << per_sigma * m.H.row(i).transpose(), per_sigma * m.H_vehicle.row(i).transpose();
      row.per_sigma = per_sigma * std::sqrt(seconds / dt_s);
      row.held = held;
      rows.push_back(row);
    }
  }
};

}  // namespace

bool rests(const Trajectory& trajectory, double t_s) {
  return is_still(trajectory, t_s) && is_still(trajectory, t_s - 2.0 * kBlockS);
}

SceneAiding::SceneAiding(const Scene& scene)
    : scene_(scene),
      config_(scene.vehicle->config),
      believed_(vehicle_state(scene.vehicle->config).value) {}

bool SceneAiding::any() const {
  const VehicleConfig& c = config_;
  return c.zero_velocity || c.zero_angular_rate || c.non_holonomic || c.odometer || c.barometer ||
         c.heading;
}

std::vector<AidingRow> SceneAiding::rows(double from_s, double to_s) const {
  const SceneVehicle& vehicle = *scene_.vehicle;
  Step step{to_s - from_s, truth_at(scene_.trajectory, to_s), {}};
  step.estimate.nav = step.truth.nav;
  const Eigen::Vector3d& omega = step.truth.omega_ib_b_radps;
  const double speed_mps = step.truth.nav.v_e_mps.norm();
  if (rests(scene_.trajectory, to_s)) {
    if (config_.zero_velocity) {
      step.add(kExactRow, zero_velocity(step.estimate, config_.rest_sigma_mps), kBlockS, 1.0,
               Held::kHeadingAndTurn);
    }
    if (config_.zero_angular_rate) {
      const double noise_radps = scene_.filter.imu.gyro.noise_density / std::sqrt(kBlockS);
      const double sigma_radps = std::hypot(noise_radps, config_.rest_turn_sigma_radps);
      step.add(kRateRow, zero_angular_rate(step.estimate, omega, sigma_radps), kBlockS, 1.0,
               Held::kHeading);
    }
  } else if (config_.non_holonomic && speed_mps >= config_.min_speed_mps) {
    const double right_mps =
        std::hypot(config_.right_sigma_mps, config_.right_sigma_m * omega.norm());
    step.add(kExactRow,
             non_holonomic(step.estimate, believed_, omega, right_mps,
                           config_.down_sigma_m2ps2 / speed_mps),
             kBlockS, 1.0, Held::kNothing);
  }
  const auto add_sensor = [&](const std::optional<VehicleSensor>& sensor, RowKind kind,
                              auto reading) {
    if (!sensor) return;
    auto& [time, value, sigma] = reading;
    sigma = sensor->sigma;
    step.add(kind, measurement(reading, step.estimate, believed_, omega), sensor->interval_s,
             sensor->interval_s, Held::kNothing);
  };
  add_sensor(vehicle.odometer, kOdometerRow, OdometerSpeed{});
  add_sensor(vehicle.barometer, kBarometerRow, BarometricHeight{});
  add_sensor(vehicle.heading, kHeadingRow, MeasuredHeading{});
  return std::move(step.rows);
}

}  // namespace leeway::sim
