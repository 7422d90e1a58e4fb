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

}  // namespace leeway
