/// @file
/// The 15-state error-state extended Kalman filter around the strapdown.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "leeway/covariance/covariance.hpp"
#include "leeway/covariance/transition.hpp"
#include "leeway/earth/fields.hpp"
#include "leeway/ekf/ekf_config.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/model/vehicle_state.hpp"
#include "leeway/sensors/gnss_fix.hpp"
#include "leeway/sensors/imu.hpp"
#include "leeway/sensors/imu_error_model.hpp"
#include "leeway/strapdown/solution.hpp"
#include "leeway/strapdown/strapdown.hpp"

namespace leeway {

/// Whether filters of any kind can begin with this.
/// @throws Error when the configuration or the estimate is invalid: the field, its value, the
/// allowed range.
void validate(const EkfConfig& config, const Estimate& estimate);

/// 1-sigma of the initial error, isotropic per group except attitude.
struct InitialSigma {
  double tilt_rad{};
  double heading_rad{};
  double velocity_mps{};
  double position_m{};

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"tilt_rad", c.tilt_rad, kNotNegative},
                   Field{"heading_rad", c.heading_rad, kNotNegative},
                   Field{"velocity_mps", c.velocity_mps, kNotNegative},
                   Field{"position_m", c.position_m, kNotNegative});
  }
};

/// What became of a fix.
struct UpdateOutcome {
  enum class Outcome { kFused, kGated, kUnusable };
  Outcome outcome{Outcome::kUnusable};
  Time time{};
  int dof{0};                ///< components of the fix
  double nis{0.0};           ///< normalized innovation squared of the whole fix, by its own R
  double gate{0.0};          ///< the NIS above which it is refused
  double position_nis{0.0};  ///< of a fix's position alone, 3 components; else 0
  double velocity_nis{0.0};
  Eigen::Vector3d position_innovation_e_m{Eigen::Vector3d::Zero()};
  Eigen::Vector3d velocity_innovation_e_mps{Eigen::Vector3d::Zero()};
  double log_det_S{0.0};           ///< of the innovation's covariance; with the NIS, the likelihood
  bool covariance_positive{true};  ///< no diagonal element and no innovation variance <= 0
};

/// What an update leaves as it is, estimate and variance, while its uncertainty counts: a Schmidt
/// update. At rest a linearized filter takes the noise of its own estimate for motion, and that for
/// knowledge of the heading.
enum class Held {
  kNothing,
  kHeading,
  kHeadingAndTurn,  ///< and the gyro bias about the vertical
};

/// What the monitor of a receiver makes of its claims: factors on the standard deviations of
/// position and velocity; and what its fixes cannot tell.
struct FixTrust {
  double position_sigma_scale{1.0};
  double velocity_sigma_scale{1.0};
  Held held{Held::kNothing};
};

/// Owns the estimate, its covariance and the transition since it was last propagated. predict,
/// update and coast allocate nothing, throw nothing, log nothing; same inputs give the same bits.
class Ekf {
 public:
  /// @throws Error when the configuration is invalid: the field, its value, the allowed range.
  Ekf(const EkfConfig& config, const Estimate& estimate, const ErrorMatrix& P);

  /// Advances by one increment. @pre inc.time - inc.dt_s = estimate().nav.time, inc.dt_s > 0.
  void predict(const ImuIncrement& inc);

  /// Carries the state over a time without IMU data: constant velocity relative to the Earth,
  /// attitude held in the Earth-fixed frame, and an uncertainty that grows as that of a vehicle
  /// that may turn at 0.5 rad/s, up to 1 rad, lean by as much up to 0.1 rad, and accelerate at
  /// 3 m/s^2 (1 sigma).
  /// @pre to > estimate().nav.time.
  void coast(Time to);

  /// Gates the whole fix, then fuses it. @pre fix.time equals estimate().nav.time.
  /// @param trust  what the fix is weighted by beyond its own R and the correlation time
  UpdateOutcome update(const GnssFix& fix, const FixTrust& trust = {});

  /// The same for any measurement at the time of the estimate. @pre m.R is positive definite.
  UpdateOutcome update(const Measurement& m, Held held = Held::kNothing);

  /// leeway::rest_hides_heading() of this filter.
  bool rest_hides_heading() const;

  /// 1 sigma of the attitude error about the vertical.
  double heading_sigma_rad() const;

  const Estimate& estimate() const { return estimate_; }

  /// Covariance at the estimate's time. Reading it changes nothing.
  ErrorMatrix covariance() const;

  /// Whether P has been propagated up to the estimate's time.
  bool covariance_is_current() const { return Phi_.dt_s == 0.0; }

  /// From now on the parameters of the vehicle are estimated too.
  /// @pre P symmetric positive semidefinite, everything finite.
  void estimate_vehicle(const VehicleState& vehicle);
  bool estimates_vehicle() const { return estimates_vehicle_; }
  const VehicleState& vehicle() const { return vehicle_; }

  /// Renames the body axes: what was v_b is C_new_old * v_b. The vehicle's parameters are
  /// forgotten.
  /// @param lever_arm_b_m  IMU to antenna in the new axes
  void turn_body_axes(const Eigen::Matrix3d& C_new_old, const Eigen::Vector3d& lever_arm_b_m);

  /// Multiplies the covariance: what the filter knows has proved wrong. @pre factor >= 1.
  void widen(double factor);

  /// Adds to the variance of every component of the position.
  void widen_position(double variance_m2);

  /// Position and velocity anew, independent of everything else; attitude and biases stay.
  /// @pre everything finite, covariances symmetric positive definite.
  void restart_motion(const Eigen::Vector3d& r_e_m, const Eigen::Matrix3d& P_rr_m2,
                      const Eigen::Vector3d& v_e_mps, const Eigen::Matrix3d& P_vv_m2ps2);

  /// Whether estimate and covariance are numbers of a size that arithmetic can bear.
  bool is_sane() const;

  /// Whether P is positive definite. If not, its negative directions are raised to a billionth of
  /// their scale. @returns whether there was nothing to repair.
  bool repair_covariance();

  const EkfConfig& config() const { return config_; }
  const ProcessNoise& noise() const { return noise_; }

  /// Measured rate (bias not removed), its mean over the last kMeanRateS: the present motion
  /// without the vibration and steering of single samples. Exponentially weighted; zero before any
  /// data.
  const Eigen::Vector3d& mean_omega_ib_b_radps() const { return mean_omega_ib_b_radps_; }
  static constexpr double kMeanRateS = 5.0;

  /// Measured rate (bias not removed) of the newest increment; zero before any data.
  const Eigen::Vector3d& omega_ib_b_radps() const { return omega_ib_b_radps_; }

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(estimate_, P_, vehicle_, estimates_vehicle_, Phi_, gravity_gradient_e_, history_,
            last_position_fix_, omega_ib_b_radps_, mean_omega_ib_b_radps_, mean_rate_window_s_,
            config_.lever_arm_b_m);
  }

 private:
  void flush();
  double position_weight(Time t) const;
  MeasurementMatrix innovation_covariance(const Measurement& m) const;
  UpdateOutcome judge(const Measurement& m);
  void fuse(const Measurement& m, const Eigen::Matrix<double, 6, 1>& weights, Held held);

  EkfConfig config_;
  ProcessNoise noise_;
  StrapdownFunction strapdown_step_;
  std::array<double, 7> gate_{};  // by degrees of freedom
  Estimate estimate_;
  ErrorMatrix P_;
  VehicleState vehicle_{};
  bool estimates_vehicle_{false};
  Transition Phi_{};
  Eigen::Matrix3d gravity_gradient_e_{Eigen::Matrix3d::Zero()};  // where Phi_ begins
  ImuHistory history_{};
  std::optional<Time> last_position_fix_{};
  Eigen::Vector3d omega_ib_b_radps_{Eigen::Vector3d::Zero()};  // of the newest increment
  Eigen::Vector3d mean_omega_ib_b_radps_{Eigen::Vector3d::Zero()};
  double mean_rate_window_s_{0.0};  // grows to kMeanRateS: the first mean is over all there is
};

/// P from sigmas: tilt and heading about the axes of north-east-down at the estimate, bias sigmas
/// from the model (turn-on and in-run together), zero where there is no state.
ErrorMatrix initial_covariance(const Estimate& estimate, const InitialSigma& sigma,
                               const ImuErrorModel& imu, const BiasStates& biases = {});

/// Whether a standstill cannot tell the heading better than it is known: the rate of the Earth that
/// would tell it is hidden in the gyro's bias.
bool rest_hides_heading(const ImuErrorModel& imu, const Estimate& estimate, const ErrorMatrix& P);

/// Whether every direction of the error has a variance: the Cholesky factor exists.
bool is_positive_definite(const ErrorMatrix& P);

/// Variance of a turn about the local vertical: of the heading.
double heading_variance_rad2(const Estimate& estimate, const ErrorMatrix& P);

/// A filter of this configuration at some place on Earth: to see whether there can be one.
/// @throws Error when the configuration is invalid.
Ekf filter_anywhere(const EkfConfig& config);

/// The estimate as people read it, with 1-sigma; nis and nis_dof are left unset.
Solution solution(const Estimate& estimate, const ErrorMatrix& P);

}  // namespace leeway
