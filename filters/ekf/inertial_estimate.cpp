#include "leeway/ekf/inertial_estimate.hpp"

#include <algorithm>

#include "leeway/earth/earth.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {

InertialEstimate::InertialEstimate(const EkfConfig& config, const Estimate& estimate)
    : config_(config),
      noise_(process_noise(config.imu, config.biases)),
      strapdown_step_(strapdown_function(config.strapdown)),
      estimate_(estimate) {
  validate(config, estimate);
}

ErrorDynamics InertialEstimate::advance(const ImuIncrement& inc) {
  ImuIncrement corrected = inc;
  corrected.dtheta_b_rad -= inc.dt_s * estimate_.bias.b_g_radps;
  corrected.dv_b_mps -= inc.dt_s * estimate_.bias.b_a_mps2;
  omega_ib_b_radps_ = 1.0 / inc.dt_s * inc.dtheta_b_rad;
  mean_rate_window_s_ = std::max(std::min(mean_rate_window_s_ + inc.dt_s, kMeanRateS), inc.dt_s);
  mean_omega_ib_b_radps_ +=
      inc.dt_s / mean_rate_window_s_ * (omega_ib_b_radps_ - mean_omega_ib_b_radps_);
  const StrapdownStep step = strapdown_step_(estimate_.nav, corrected, history_);
  mean_force_e_mps2_ +=
      1.0 / mean_rate_window_s_ * (step.dv_f_e_mps - inc.dt_s * mean_force_e_mps2_);
  const ErrorDynamics dynamics{.dt_s = inc.dt_s,
                               .C_eb_mean = step.C_eb_mean,
                               .dv_f_e_mps = step.dv_f_e_mps,
                               .a_a = bias_decay(inc.dt_s, noise_.tau_a_s),
                               .g_g = bias_decay(inc.dt_s, noise_.tau_g_s)};
  estimate_.bias.b_a_mps2 *= dynamics.a_a;
  estimate_.bias.b_g_radps *= dynamics.g_g;
  return dynamics;
}

ProcessNoise InertialEstimate::noise() const {
  // Along the radius gravity is 0.2 deg off the plumb line: 0.03 m/s^2, nothing beside a manoeuvre.
  const Eigen::Vector3d up_e = estimate_.nav.r_e_m.normalized();
  const MeanMotion motion{
      mean_omega_ib_b_radps_ - estimate_.bias.b_g_radps,
      mean_rate_window_s_ > 0.0 ? Eigen::Vector3d(mean_force_e_mps2_ - kStandardGravityMps2 * up_e)
                                : Eigen::Vector3d::Zero()};
  return with_motion(scaled(noise_, noise_scale_), config_.imu, motion);
}

Measurement InertialEstimate::measurement(const GnssFix& fix) const {
  return gnss_measurement(fix, estimate_, config_.lever_arm_b_m, omega_ib_b_radps_);
}

void InertialEstimate::turn_body_axes(const Eigen::Matrix3d& C_new_old,
                                      const Eigen::Vector3d& lever_arm_b_m) {
  config_.lever_arm_b_m = lever_arm_b_m;
  estimate_.nav.q_eb =
      (estimate_.nav.q_eb * Eigen::Quaterniond(C_new_old.transpose())).normalized();
  estimate_.bias.b_a_mps2 = C_new_old * estimate_.bias.b_a_mps2;
  estimate_.bias.b_g_radps = C_new_old * estimate_.bias.b_g_radps;
  omega_ib_b_radps_ = C_new_old * omega_ib_b_radps_;
  mean_omega_ib_b_radps_ = C_new_old * mean_omega_ib_b_radps_;
  history_ = ImuHistory{};
}

}  // namespace leeway
