#include "leeway/sim/sensors/gnss_simulator.hpp"

#include "leeway/earth/earth.hpp"
#include "leeway/earth/error.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "lib/earth/field_walk.hpp"

namespace leeway::sim {

void validate(const GnssErrorModel& model) {
  validate_fields("GNSS simulator", model);
  const Eigen::Vector3d total_m = model.position_sigma_n_m + model.correlated_sigma_n_m;
  require("GNSS simulator", "position_sigma_n_m + correlated_sigma_n_m", total_m.minCoeff(),
          kPositive);
}

GnssSimulator::GnssSimulator(const Trajectory& trajectory, const GnssErrorModel& model,
                             const Random& random)
    : trajectory_(trajectory), model_(model), random_(random) {
  validate(model_);
  if (!trajectory_.motion) throw Error("trajectory '" + trajectory_.name + "' has no motion");
  correlated_error_n_m_ = model_.correlated_sigma_n_m.cwiseProduct(random_.normal3());
}

void GnssSimulator::advance_correlated_error(double t_s) {
  const double after_s = last_s_.value_or(kFinite.low);
  require("GNSS simulator", "time of a fix", t_s, {.low = after_s, .above_low = true});
  if (last_s_) {
    const GaussMarkovStep step =
        discretize({.sigma = 1.0, .tau_s = model_.correlation_time_s}, t_s - *last_s_);
    correlated_error_n_m_ =
        step.phi * correlated_error_n_m_ +
        step.sigma_end * model_.correlated_sigma_n_m.cwiseProduct(random_.normal3());
  }
  last_s_ = t_s;
}

GnssFix GnssSimulator::fix_at(double t_s) {
  advance_correlated_error(t_s);
  const TruthPoint truth = truth_at(trajectory_, t_s);
  const Eigen::Matrix3d C_eb = truth.nav.q_eb.toRotationMatrix();
  const Eigen::Vector3d omega_eb_b_radps =
      truth.omega_ib_b_radps - C_eb.transpose() * earth_rotation_e_radps();
  const Eigen::Vector3d antenna_e_m = truth.nav.r_e_m + C_eb * model_.lever_arm_b_m;
  const Eigen::Vector3d antenna_e_mps =
      truth.nav.v_e_mps + C_eb * omega_eb_b_radps.cross(model_.lever_arm_b_m);

  const Eigen::Vector3d position_error_n_m =
      correlated_error_n_m_ + model_.position_sigma_n_m.cwiseProduct(random_.normal3());
  const Eigen::Vector3d velocity_error_n_mps =
      model_.velocity_sigma_n_mps.cwiseProduct(random_.normal3());
  const Eigen::Vector3d position_variance_n_m2 =
      model_.position_sigma_n_m.cwiseAbs2() + model_.correlated_sigma_n_m.cwiseAbs2();
  const Eigen::Vector3d velocity_variance_n_m2ps2 = model_.velocity_sigma_n_mps.cwiseAbs2();

  const Eigen::Matrix3d C_en = ned_to_ecef(geodetic_from_ecef(antenna_e_m));
  GnssFix fix;
  fix.time = truth.nav.time;
  fix.position = GnssPosition{antenna_e_m + C_en * position_error_n_m,
                              C_en * position_variance_n_m2.asDiagonal() * C_en.transpose()};
  fix.velocity = GnssVelocity{antenna_e_mps + C_en * velocity_error_n_mps,
                              C_en * velocity_variance_n_m2ps2.asDiagonal() * C_en.transpose()};
  return fix;
}

}  // namespace leeway::sim
