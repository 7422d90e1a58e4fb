#include "leeway/ekf/inertial_estimate.hpp"

#include "filters/covariance/cholesky.hpp"
#include "leeway/model/gnss_measurement.hpp"

namespace leeway {

InertialEstimate::InertialEstimate(const EkfConfig& config, const Estimate& estimate)
    : noise_(process_noise(config.imu, config.biases)),
      strapdown_step_(strapdown_function(config.strapdown)),
      lever_arm_b_m_(config.lever_arm_b_m),
      estimate_(estimate) {
  validate(config, estimate);
}

ErrorDynamics InertialEstimate::advance(const ImuIncrement& inc) {
  ImuIncrement corrected = inc;
  corrected.dtheta_b_rad -= inc.dt_s * estimate_.bias.b_g_radps;
  corrected.dv_b_mps -= inc.dt_s * estimate_.bias.b_a_mps2;
  omega_ib_b_radps_ = 1.0 / inc.dt_s * inc.dtheta_b_rad;
  const StrapdownStep step = strapdown_step_(estimate_.nav, corrected, history_);
  const ErrorDynamics dynamics{.dt_s = inc.dt_s,
                               .C_eb_mean = step.C_eb_mean,
                               .dv_f_e_mps = step.dv_f_e_mps,
                               .a_a = bias_decay(inc.dt_s, noise_.tau_a_s),
                               .g_g = bias_decay(inc.dt_s, noise_.tau_g_s)};
  estimate_.bias.b_a_mps2 *= dynamics.a_a;
  estimate_.bias.b_g_radps *= dynamics.g_g;
  return dynamics;
}

Measurement InertialEstimate::measurement(const GnssFix& fix) const {
  return gnss_measurement(fix, estimate_, lever_arm_b_m_, omega_ib_b_radps_);
}

WhiteMeasurement InertialEstimate::white_measurement(const GnssFix& fix,
                                                     double position_weight) const {
  const Measurement m = measurement(fix);
  const Cholesky<6> R_factor(m.R);
  WhiteMeasurement white{R_factor.whitened(m.H), R_factor.whitened(m.innovation)};
  if (fix.position) {
    white.H.topRows<3>() *= position_weight;
    white.z.head<3>() *= position_weight;
  }
  return white;
}

}  // namespace leeway
