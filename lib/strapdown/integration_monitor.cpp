#include "leeway/strapdown/integration_monitor.hpp"

#include <algorithm>

#include "lib/strapdown/scheme_terms.hpp"

namespace leeway {
namespace {

/// A sine of six samples in a period changes from one to the next by as much as it has: the mean
/// square of the change is 4 sin^2(omega dt / 2) of its own.
constexpr double kUnresolved = 1.0;
constexpr double kFirstS = 1.0;      // shorter means are those of a few samples of chance
constexpr double kAboveNoise = 4.0;  // in variance: no chance of hundreds of increments

void average(LeftOut& mean, const LeftOut& value, double gain) {
  mean.rate_b_radps += gain * (value.rate_b_radps - mean.rate_b_radps);
  mean.force_b_mps2 += gain * (value.force_b_mps2 - mean.force_b_mps2);
}

LeftOut operator+(const LeftOut& a, const LeftOut& b) {
  return {a.rate_b_radps + b.rate_b_radps, a.force_b_mps2 + b.force_b_mps2};
}

}  // namespace

IntegrationMonitor::IntegrationMonitor(const ImuErrorModel& imu)
    : gyro_noise_((validate(imu), imu.gyro.noise_density)),
      accelerometer_noise_(imu.accelerometer.noise_density) {}

void IntegrationMonitor::Variation::note(const Eigen::Vector3d& rate,
                                         const Eigen::Vector3d& last_rate, double gain) {
  mean_rate += gain * (rate - mean_rate);
  square += gain * ((rate - mean_rate).squaredNorm() - square);
  change_square += gain * ((rate - last_rate).squaredNorm() - change_square);
}

void IntegrationMonitor::push(const ImuIncrement& inc) {
  const double dt_s = inc.dt_s;
  recent_[2] = recent_[1];
  recent_[1] = recent_[0];
  recent_[0] = {inc.dtheta_b_rad / dt_s, inc.dv_b_mps / dt_s};
  if (count_ < 2) {
    ++count_;
    return;
  }
  window_s_ = std::min(window_s_ + dt_s, kMeanS);
  const double gain = dt_s / window_s_;
  mean_dt_s_ += gain * (dt_s - mean_dt_s_);
  const auto& [omega, f] = recent_[0];
  const auto& [last_omega, last_f] = recent_[1];
  gyro_.note(omega, last_omega, gain);
  accelerometer_.note(f, last_f, gain);

  average(first_order_, {Eigen::Vector3d::Zero(), 0.5 * dt_s * omega.cross(f)}, gain);
  average(pair_,
          {dt_s / 12.0 * last_omega.cross(omega),
           dt_s / 12.0 * (last_omega.cross(f) + last_f.cross(omega))},
          gain);
  // Cubic integrals instead of quadratic ones: 7/60 of the last increment and -1/60 of the one
  // before it, where a pair has 5/60 and nothing.
  const Eigen::Vector3d omega_beyond = 2.0 * last_omega - recent_[2].omega_b_radps;
  const Eigen::Vector3d f_beyond = 2.0 * last_f - recent_[2].f_b_mps2;
  average(beyond_,
          {dt_s / 60.0 * omega_beyond.cross(omega),
           dt_s / 60.0 * (omega_beyond.cross(f) + f_beyond.cross(omega))},
          gain);
}

LeftOut IntegrationMonitor::left_out(Scheme scheme) const {
  if (window_s_ < kFirstS) return {};
  const SchemeTerms takes = scheme_terms(scheme);
  LeftOut left_out = takes.turning_force ? LeftOut{} : first_order_;
  if (!takes.coning) left_out.rate_b_radps += pair_.rate_b_radps;
  if (!takes.sculling) left_out.force_b_mps2 += pair_.force_b_mps2;
  return left_out + beyond_;
}

bool IntegrationMonitor::resolves_motion() const {
  if (window_s_ < kFirstS) return true;
  const auto resolved = [this](const Variation& v, double noise_density) {
    const double noise = mean_dt_s_ > 0.0 ? 3.0 * noise_density * noise_density / mean_dt_s_ : 0.0;
    return v.square <= kAboveNoise * noise || v.change_square <= kUnresolved * v.square;
  };
  return resolved(gyro_, gyro_noise_) && resolved(accelerometer_, accelerometer_noise_);
}

}  // namespace leeway
