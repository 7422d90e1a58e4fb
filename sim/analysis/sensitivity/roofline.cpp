#include "leeway/sim/analysis/roofline.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/model/error_metric.hpp"
#include "sim/analysis/sensitivity/by_metric.hpp"

namespace leeway::sim {
namespace {

constexpr double kRooflineGravityMps2 = kStandardGravityMps2;
constexpr double kShortestRoofS = 1e-3;
constexpr double kLongestRoofS = 1e6;

/// The lines are those of a horizontal error, and what they cross is level.
bool has_lines(const ErrorLimit& limit) {
  return !asks_for_height(limit.metric) && limit.share == 0.0;
}

/// Of north and east.
double horizontal_rms(const Eigen::Vector3d& sigma_n) {
  return std::sqrt(0.5 * sigma_n.head<2>().squaredNorm());
}

/// 1 sigma of the turn-on bias with what the filter is not told of the known part.
double unknown_bias(const TriadErrorModel& triad, const TriadErrorModel& believed) {
  return std::hypot(triad.bias_sigma, horizontal_rms(triad.bias - believed.bias));
}

/// What is left of a constant bias after a time under white noise of the same sensor.
double calibrated_bias(double sigma, double noise_density, double time_s) {
  if (sigma == 0.0) return 0.0;
  const double learnt_per_s = sigma * sigma / (noise_density * noise_density);
  return noise_density == 0.0 ? 0.0 : sigma / std::sqrt(1.0 + learnt_per_s * time_s);
}

/// Density of the random walk that a Gauss-Markov process is over times short beside its own.
double walk_density(const GaussMarkov& drift) {
  return drift.sigma == 0.0 ? 0.0 : drift.sigma * std::sqrt(2.0 / drift.tau_s);
}

/// The longest interval at which a growing error is within the limit.
template <class F>
double longest_within(double limit_m, F&& error_m) {
  if (error_m(kShortestRoofS) > limit_m || error_m(kLongestRoofS) <= limit_m) return std::nan("");
  double low = std::log(kShortestRoofS);
  double high = std::log(kLongestRoofS);
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);
    (error_m(std::exp(middle)) > limit_m ? high : low) = middle;
  }
  return std::exp(low);
}

}  // namespace

Roofline::Roofline(const Scene& scene)
    : by_metric_(has_lines(scene.limit) ? size_by_metric_m(scene, Eigen::Matrix3d::Identity())
                                        : 0.0),
      duration_s_(scene.duration_s),
      position_m_(horizontal_rms(scene.gnss.errors.position_sigma_n_m)),
      correlated_m_(horizontal_rms(scene.gnss.errors.correlated_sigma_n_m)),
      correlation_s_(scene.gnss.errors.correlation_time_s),
      velocity_mps_(horizontal_rms(scene.gnss.errors.velocity_sigma_n_mps)),
      imu_(scene.imu),
      accelerometer_bias_mps2_(
          unknown_bias(scene.imu.accelerometer, scene.filter.imu.accelerometer)),
      gyro_bias_radps_(unknown_bias(scene.imu.gyro, scene.filter.imu.gyro)) {
  validate(scene);
}

double Roofline::error_m(RooflineTerm term, double interval_s) const {
  return by_metric_ * sigma_m(term, interval_s);
}

double Roofline::lost_velocity_mps(double interval_s) const {
  const double tilt_mps =
      kRooflineGravityMps2 * imu_.gyro.noise_density * interval_s / std::sqrt(3.0);
  const double drift_mps =
      std::hypot(walk_density(imu_.accelerometer.in_run) * interval_s / std::sqrt(3.0),
                 kRooflineGravityMps2 * walk_density(imu_.gyro.in_run) * interval_s * interval_s /
                     std::sqrt(20.0));
  return std::sqrt(interval_s) * std::hypot(imu_.accelerometer.noise_density, tilt_mps, drift_mps);
}

// The equations of docs/theory/analysis/roofline.md, per axis.
double Roofline::sigma_m(RooflineTerm term, double interval_s) const {
  const double T = interval_s;
  const double g = kRooflineGravityMps2;
  const double learning_s = std::max(duration_s_ - T, 0.0);
  const TriadErrorModel& accelerometer = imu_.accelerometer;
  const TriadErrorModel& gyro = imu_.gyro;
  switch (term) {
    case RooflineTerm::kFixPosition:  // (1)
      return std::min(std::sqrt(position_m_ * velocity_mps_ * T), position_m_);
    case RooflineTerm::kFixCorrelated:  // (2)
      return std::min(std::sqrt(correlated_m_ * velocity_mps_ *
                                std::sqrt(T * std::max(2.0 * correlation_s_, T))),
                      correlated_m_);
    case RooflineTerm::kFixVelocity:  // (3)
      return T * std::min(velocity_mps_, std::sqrt(velocity_mps_ * lost_velocity_mps(T)));
    case RooflineTerm::kAccelerometerNoise:  // (4)
      return accelerometer.noise_density * std::sqrt(std::pow(T, 3) / 3.0);
    case RooflineTerm::kAccelerometerBias:  // (5)
      return 0.5 * T * T *
             calibrated_bias(accelerometer_bias_mps2_, accelerometer.noise_density, learning_s);
    case RooflineTerm::kAccelerometerDrift:  // (6)
      return std::min(
          walk_density(accelerometer.in_run) * std::sqrt(kThreeIntegrators * std::pow(T, 5)),
          0.5 * accelerometer.in_run.sigma * T * T);
    case RooflineTerm::kGyroNoise:  // (7)
      return g * gyro.noise_density * std::sqrt(kThreeIntegrators * std::pow(T, 5));
    case RooflineTerm::kGyroBias:  // (8)
      return g * std::pow(T, 3) / 6.0 *
             calibrated_bias(gyro_bias_radps_, gyro.noise_density, learning_s);
    case RooflineTerm::kGyroDrift:  // (9)
      break;
  }
  return g * std::min(walk_density(gyro.in_run) * std::sqrt(kFourIntegrators * std::pow(T, 7)),
                      gyro.in_run.sigma * std::pow(T, 3) / 6.0);
}

double Roofline::roof_m(double interval_s) const {
  double highest_m = 0.0;
  for (const RooflineTerm term : kAll<RooflineTerm>) {
    highest_m = std::max(highest_m, error_m(term, interval_s));
  }
  return highest_m;
}

double Roofline::sum_m(double interval_s) const {
  double sum_m2 = 0.0;
  for (const RooflineTerm term : kAll<RooflineTerm>) {
    sum_m2 += std::pow(error_m(term, interval_s), 2);
  }
  return std::sqrt(sum_m2);
}

double Roofline::interval_s(double limit_m) const {
  return longest_within(limit_m, [this](double T) { return roof_m(T); });
}

double Roofline::sum_interval_s(double limit_m) const {
  return longest_within(limit_m, [this](double T) { return sum_m(T); });
}

}  // namespace leeway::sim
