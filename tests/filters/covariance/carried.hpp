/// @file
/// Estimates carried along IMU data by the nonlinear model, and the Phi of the way.
#pragma once

#include <cmath>
#include <vector>

#include "leeway/covariance/transition.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway::test {

/// The nonlinear model: the estimate, biases included, carried along what the sensors measured. A
/// bias decays exponentially; its integral is taken out of the increment.
inline void carry(Estimate& estimate, const std::vector<ImuIncrement>& measured, double tau_a_s,
                  double tau_g_s) {
  ImuHistory history;
  const auto decay = [](Eigen::Vector3d& bias, double dt_s, double tau_s) -> Eigen::Vector3d {
    if (std::isinf(tau_s)) return dt_s * bias;
    const Eigen::Vector3d integral = -std::expm1(-dt_s / tau_s) * tau_s * bias;
    bias *= std::exp(-dt_s / tau_s);
    return integral;
  };
  for (ImuIncrement inc : measured) {
    inc.dv_b_mps -= decay(estimate.bias.b_a_mps2, inc.dt_s, tau_a_s);
    inc.dtheta_b_rad -= decay(estimate.bias.b_g_radps, inc.dt_s, tau_g_s);
    strapdown_step<Scheme::kRungeKutta4>(estimate.nav, inc, history);
  }
}

/// Phi as the filter accumulates it.
inline Transition accumulated(NavState state, const std::vector<ImuIncrement>& increments) {
  Transition Phi;
  ImuHistory history;
  for (const ImuIncrement& inc : increments) {
    ErrorDynamics dynamics;
    dynamics.dt_s = inc.dt_s;
    dynamics.gravity_gradient_e = gravity_gradient_e(state.r_e_m);
    const StrapdownStep step = strapdown_step<>(state, inc, history);
    dynamics.C_eb_mean = step.C_eb_mean;
    dynamics.dv_f_e_mps = step.dv_f_e_mps;
    advance(Phi, dynamics);
  }
  return Phi;
}

}  // namespace leeway::test
