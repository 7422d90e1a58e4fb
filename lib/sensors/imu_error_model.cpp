#include "leeway/sensors/imu_error_model.hpp"

#include <cmath>
#include <sstream>

#include "leeway/earth/error.hpp"

namespace leeway {
namespace {

// 2a - 3 + 4 exp(-a) - exp(-2a), the variance of the integral in units of (sigma tau)^2. Below 0.5
// its leading terms cancel: the coefficient of a^n is (-1)^n (4 - 2^n) / n!.
double integral_variance(double a) {
  if (a > 0.5) return 2.0 * a - 3.0 + 4.0 * std::exp(-a) - std::exp(-2.0 * a);
  double sum = 0.0;
  double power_over_factorial = a * a / 2.0;
  double two_to_n = 4.0;
  for (int n = 3; n < 22; ++n) {
    power_over_factorial *= -a / n;
    two_to_n *= 2.0;
    sum += (4.0 - two_to_n) * power_over_factorial;
  }
  return sum;
}

// The message is put together only when it is needed: a filter is made, and its model validated, in
// the middle of a drive, where nothing may touch the heap.
void require(bool ok, const char* owner, const char* field, double value, const char* range) {
  if (ok) return;
  std::ostringstream message;
  message << "IMU error model: " << owner << field << " is " << value << ", must be " << range;
  throw Error(message.str());
}

void require_non_negative(const char* owner, const char* field, double value) {
  require(std::isfinite(value) && value >= 0.0, owner, field, value, "finite and >= 0");
}

void validate(const TriadErrorModel& triad, const char* owner) {
  require(triad.bias.allFinite(), owner, "bias", triad.bias.norm(), "finite");
  require(triad.M.allFinite(), owner, "M", triad.M.norm(), "finite");
  require_non_negative(owner, "bias_sigma", triad.bias_sigma);
  require_non_negative(owner, "scale_sigma", triad.scale_sigma);
  require_non_negative(owner, "misalignment_sigma_rad", triad.misalignment_sigma_rad);
  require_non_negative(owner, "noise_density", triad.noise_density);
  require_non_negative(owner, "in_run.sigma", triad.in_run.sigma);
  require(triad.in_run.tau_s > 0.0, owner, "in_run.tau_s", triad.in_run.tau_s, "> 0");
  require_non_negative(owner, "quantum", triad.quantum);
  require(triad.range > 0.0, owner, "range", triad.range, "> 0");
}

}  // namespace

GaussMarkovStep discretize(const GaussMarkov& process, double dt_s) {
  require(std::isfinite(dt_s) && dt_s > 0.0, "", "dt_s", dt_s, "finite and > 0");
  require_non_negative("", "sigma", process.sigma);
  require(process.tau_s > 0.0, "", "tau_s", process.tau_s, "> 0");
  GaussMarkovStep step;
  if (std::isinf(process.tau_s)) {
    step.integral_gain_s = dt_s;
    return step;
  }
  const double a = dt_s / process.tau_s;
  const double one_minus_phi = -std::expm1(-a);
  const double end_variance = -std::expm1(-2.0 * a);        // in sigma^2
  const double covariance = one_minus_phi * one_minus_phi;  // in sigma^2 tau
  step.phi = std::exp(-a);
  step.integral_gain_s = process.tau_s * one_minus_phi;
  step.sigma_end = process.sigma * std::sqrt(end_variance);
  step.integral_slope_s = process.tau_s * covariance / end_variance;
  step.sigma_integral = process.sigma * process.tau_s *
                        std::sqrt(integral_variance(a) - covariance * covariance / end_variance);
  return step;
}

void validate(const ImuErrorModel& model) {
  validate(model.accelerometer, "accelerometer.");
  validate(model.gyro, "gyro.");
  require(model.G_g_radps_per_mps2.allFinite(), "", "G_g_radps_per_mps2",
          model.G_g_radps_per_mps2.norm(), "finite");
  require_non_negative("", "G_g_sigma_radps_per_mps2", model.G_g_sigma_radps_per_mps2);
}

}  // namespace leeway
