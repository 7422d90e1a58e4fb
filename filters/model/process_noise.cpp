#include "leeway/model/process_noise.hpp"

#include <cmath>

namespace leeway {
namespace {

struct BiasDrive {
  double density;
  double tau_s;
};

BiasDrive bias_drive(const TriadErrorModel& triad, BiasState state) {
  const double infinity = std::numeric_limits<double>::infinity();
  const GaussMarkov& in_run = triad.in_run;
  const bool is_driven = state == BiasState::kModelled || state == BiasState::kRandomWalk;
  if (!is_driven || in_run.sigma == 0.0 || std::isinf(in_run.tau_s)) return {0.0, infinity};
  const double density = 2.0 * in_run.sigma * in_run.sigma / in_run.tau_s;
  const bool decays = state == BiasState::kModelled && triad.bias_sigma == 0.0;
  return {density, decays ? in_run.tau_s : infinity};
}

}  // namespace

ProcessNoise process_noise(const ImuErrorModel& model, const BiasStates& biases) {
  validate(model);
  const BiasDrive a = bias_drive(model.accelerometer, biases.accelerometer);
  const BiasDrive g = bias_drive(model.gyro, biases.gyro);
  return {
      .attitude_rad2_per_s = model.gyro.noise_density * model.gyro.noise_density,
      .velocity_m2_per_s3 = model.accelerometer.noise_density * model.accelerometer.noise_density,
      .b_a_m2_per_s5 = a.density,
      .b_g_rad2_per_s3 = g.density,
      .tau_a_s = a.tau_s,
      .tau_g_s = g.tau_s};
}

ProcessNoise with_motion(const ProcessNoise& noise, const ImuErrorModel& model,
                         const MeanMotion& motion) {
  constexpr double kTurnS = 5.0;
  const auto variance = [](const TriadErrorModel& triad) {
    return triad.scale_sigma * triad.scale_sigma +
           triad.misalignment_sigma_rad * triad.misalignment_sigma_rad;
  };
  const double rate2 = motion.omega_ib_b_radps.squaredNorm();
  const double acceleration2 = motion.acceleration_e_mps2.squaredNorm();
  const double G_g2 = model.G_g_sigma_radps_per_mps2 * model.G_g_sigma_radps_per_mps2;
  ProcessNoise result = noise;
  result.attitude_rad2_per_s += kTurnS * (variance(model.gyro) * rate2 + G_g2 * acceleration2);
  result.velocity_m2_per_s3 += kTurnS * variance(model.accelerometer) * acceleration2;
  return result;
}

ProcessNoise scaled(const ProcessNoise& noise, double sigma_scale) {
  const double variance_scale = sigma_scale * sigma_scale;
  ProcessNoise result = noise;
  result.attitude_rad2_per_s *= variance_scale;
  result.velocity_m2_per_s3 *= variance_scale;
  result.b_a_m2_per_s5 *= variance_scale;
  result.b_g_rad2_per_s3 *= variance_scale;
  return result;
}

}  // namespace leeway
