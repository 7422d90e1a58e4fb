#include "sim/analysis/aiding_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "leeway/navigator/aidings.hpp"

namespace leeway::sim {
namespace {

constexpr double kBlockS = ImuBlocks::kBlockS;
constexpr double kToRestS = 2.0 * kBlockS;  // as StandstillDetector
constexpr double kStillMps = 1e-3;
constexpr double kEvenMps2 = 0.05;  // of gravity, the tilt of a level that is known to 0.3 deg
constexpr double kEndSlack = 1e-6;  // of a step

}  // namespace

SceneAiding::SceneAiding(const Scene& scene, std::shared_ptr<const MotionSamples> motion,
                         const RestsAt& rests_at)
    : motion_(std::move(motion)),
      ends_(motion_->ends(scene.trajectory, scene.duration_s)),
      step_s_(motion_->step_s()) {
  if (scene.vehicle) believed_ = vehicle_state(scene.vehicle->config).value;
  samples_.reserve(ends_.size());
  double still_s = kToRestS;  // a scene that begins at rest has been
  double even_s = 0.0;
  Eigen::Vector3d v_e_mps = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < ends_.size(); ++k) {
    const TruthPoint& truth = ends_[k];
    const bool is_still = truth.nav.v_e_mps.norm() < kStillMps;
    const bool is_even = k == 0 || (truth.nav.v_e_mps - v_e_mps).norm() < kEvenMps2 * step_s_;
    if (k > 0) still_s += step_s_;
    if (!is_still) still_s = 0.0;
    even_s = is_even ? even_s + step_s_ : 0.0;
    v_e_mps = truth.nav.v_e_mps;
    const bool rests = rests_at ? rests_at(static_cast<double>(k) * step_s_) : still_s >= kToRestS;
    samples_.push_back(
        {rests, static_cast<float>(even_s), static_cast<std::uint32_t>(rows_.size())});
    if (k > 0 && scene.vehicle) add_rows(scene, truth);
  }
}

std::size_t SceneAiding::index_at(double t_s) const {
  const auto k = static_cast<std::size_t>(std::max(t_s / step_s_ + kEndSlack, 0.0));
  return std::min(k, samples_.size() - 1);
}

std::span<const AidingRow> SceneAiding::rows(double end_s) const {
  const double steps = end_s / step_s_;
  const double k = std::round(steps);
  if (std::abs(steps - k) > kEndSlack || k >= static_cast<double>(samples_.size())) return {};
  const auto at = static_cast<std::size_t>(k);
  const std::size_t end = at + 1 < samples_.size() ? samples_[at + 1].first_row : rows_.size();
  return {rows_.data() + samples_[at].first_row, end - samples_[at].first_row};
}

/// A measurement that comes every interval_s and is told with the variance m.R.
/// @param seconds  the time over which the noise of a true reading is that of the kind
void SceneAiding::add(RowKind kind, const Measurement& m, double interval_s, double seconds,
                      Held held) {
  for (int i = 0; i < m.rows(); ++i) {
    AidingRow row{kind};
    const double per_sigma = std::sqrt(step_s_ / interval_s / m.R(i, i));
    row.h << per_sigma * m.H.row(i).transpose(), per_sigma * m.H_vehicle.row(i).transpose();
    row.per_sigma = per_sigma * std::sqrt(seconds / step_s_);
    row.held = held;
    rows_.push_back(row);
  }
}

void SceneAiding::add_rows(const Scene& scene, const TruthPoint& truth) {
  add_constraints(scene, truth);
  add_sensors(scene, truth);
}

void SceneAiding::add_constraints(const Scene& scene, const TruthPoint& truth) {
  const VehicleConfig& config = scene.vehicle->config;
  const Estimate estimate{truth.nav, {}};
  const double speed_mps = truth.nav.v_e_mps.norm();
  if (samples_.back().rests) {
    if (config.zero_velocity) {
      add(kExactRow, zero_velocity(estimate, config.rest_sigma_mps), kBlockS, 1.0,
          Held::kHeadingAndTurn);
    }
    if (config.zero_angular_rate) {
      const double sigma_radps =
          rest_turn_sigma_radps(config, scene.filter.imu.gyro.noise_density, kBlockS);
      add(kRateRow, zero_angular_rate(estimate, truth.omega_ib_b_radps, sigma_radps), kBlockS, 1.0,
          Held::kHeading);
    }
  } else if (config.non_holonomic && speed_mps >= config.min_speed_mps) {
    const Eigen::Vector3d& omega = truth.omega_ib_b_radps;
    add(kExactRow,
        non_holonomic(estimate, believed_, omega, right_sigma_mps(config, omega.norm()),
                      down_sigma_mps(config, speed_mps)),
        kBlockS, 1.0, Held::kNothing);
  }
}

void SceneAiding::add_sensors(const Scene& scene, const TruthPoint& truth) {
  const Estimate estimate{truth.nav, {}};
  const auto add_sensor = [&](const std::optional<VehicleSensor>& sensor, RowKind kind,
                              auto reading) {
    if (!sensor) return;
    auto& [time, value, sigma] = reading;
    sigma = sensor->sigma;
    add(kind, measurement(reading, estimate, believed_, truth.omega_ib_b_radps), sensor->interval_s,
        sensor->interval_s, Held::kNothing);
  };
  add_sensor(scene.vehicle->odometer, kOdometerRow, OdometerSpeed{});
  add_sensor(scene.vehicle->barometer, kBarometerRow, BarometricHeight{});
  add_sensor(scene.vehicle->heading, kHeadingRow, MeasuredHeading{});
}

}  // namespace leeway::sim
