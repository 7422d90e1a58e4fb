#include <cmath>
#include <limits>
#include <string>

#include "leeway/covariance/transition.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "sim/atlas/linear_response.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kBiasMps2 = 1e-4;

/// A constant accelerometer bias along and across a car on a circle turns with it.
LinearResponse body_bias_on_circle(double interval_s) {
  std::vector<ErrorVector> biases;
  for (const int axis : {0, 1}) biases.push_back(kBiasMps2 * ErrorVector::Unit(kBa + axis));
  const Trajectory trajectory =
      circle({.radius_m = 50.0, .speed_mps = 20.0, .duration_s = interval_s});
  return {trajectory, 50.0, interval_s, biases};
}

double position_sigma_m(const ErrorMatrix& P) { return std::sqrt(P.block<3, 3>(kDr, kDr).trace()); }

/// (1 + F dt)^n with the F of the start: dt is the interval over 2^20.
ErrorMatrix frozen_phi(const Estimate& start, double interval_s) {
  constexpr int kDoublings = 20;
  const Eigen::Matrix3d C_eb = start.nav.q_eb.toRotationMatrix();
  const TruthPoint begin = truth_at(circle({.radius_m = 50.0, .speed_mps = 20.0}), 0.0);
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const ErrorMatrix F = system_matrix(C_eb, C_eb * begin.f_ib_b_mps2,
                                      gravity_gradient_e(start.nav.r_e_m), kNever, kNever);
  ErrorMatrix Phi = ErrorMatrix::Identity() + std::ldexp(interval_s, -kDoublings) * F;
  for (int k = 0; k < kDoublings; ++k) Phi = Phi.lazyProduct(Phi).eval();
  return Phi;
}

std::vector<AtlasCell> run_frozen_transition(const AtlasOptions& /*options*/) {
  std::vector<AtlasColumn> columns = atlas_columns();
  columns.push_back(column_of({.covariance_interval_s = 10.0}));
  return cells_over(std::vector{10.0, 60.0}, [&](double interval_s) {
    const LinearResponse response = body_bias_on_circle(interval_s);
    return response.compared(columns, std::to_string(std::lround(interval_s)) + " s",
                             position_sigma_m, "Phi frozen at the fix",
                             frozen_phi(response.start(), interval_s));
  });
}

}  // namespace

AtlasScene frozen_transition() {
  return {.place = 110,
          .key = "frozen-transition",
          .title = "The transition matrix frozen over the fix interval",
          .figure = "claimed over true position error by a body-frame bias, as a factor",
          .limits = {1.05, 1.5,
                     "a claim within 5 % is as good as the sigmas of the sensors are known; by "
                     "half, and the interval that it allows is wrong by a quarter"},
          .run = run_frozen_transition};
}

}  // namespace leeway::sim::scenes
