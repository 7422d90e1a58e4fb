#include "leeway/sensors/imu_error_model.hpp"

#include <cmath>

#include "lib/earth/field_walk.hpp"

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

}  // namespace

GaussMarkovStep discretize(const GaussMarkov& process, double dt_s) {
  require("Gauss-Markov process", "dt_s", dt_s, kPositive);
  validate_fields("Gauss-Markov process", process);
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

void validate(const ImuErrorModel& model) { validate_fields("IMU error model", model); }

}  // namespace leeway
