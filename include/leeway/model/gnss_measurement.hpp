/// @file
/// The measurement model of a GNSS fix, lever arm included.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "leeway/earth/time.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// Whether a position is that of carrier phase with fixed ambiguities: what is left is noise and
/// multipath of centimetres, which changes with every few metres. Errors of code last for half a
/// minute.
/// @param trace_m2  of its covariance
constexpr bool has_white_error(double trace_m2) {
  constexpr double kFixedM = 0.05;  // a quarter of the carrier's wavelength
  return trace_m2 < 3.0 * kFixedM * kFixedM;
}

/// Where the antenna is and how fast, for an estimate.
/// @param lever_arm_b_m     IMU to antenna, body axes
/// @param omega_ib_b_radps  measured angular rate at the time of the fix (bias not yet removed)
Eigen::Vector3d antenna_position_e(const Estimate& estimate, const Eigen::Vector3d& lever_arm_b_m);
Eigen::Vector3d antenna_velocity_e(const Estimate& estimate, const Eigen::Vector3d& lever_arm_b_m,
                                   const Eigen::Vector3d& omega_ib_b_radps);

/// What the position of a fix is weighted by, as a factor on its innovation over sigma, when its
/// error is correlated with that of a fix dt_s earlier: of a Gauss-Markov error with
/// a = exp(-dt / correlation), each fix counts as white noise of variance R (1 + a) / (1 - a).
inline double gnss_position_weight(double dt_s, double correlation_s) {
  // (1 - a) / (1 + a) is the tanh; a second fix at the same time repeats the first: weight 0.
  return correlation_s > 0.0 ? std::sqrt(std::tanh(0.5 * dt_s / correlation_s)) : 1.0;
}

/// The gnss_position_weight() of each position by the time since the one that was fused before it.
/// The first has weight 1.
class PositionWeight {
 public:
  /// @param correlation_s  of the errors of positions; 0: none, and every weight is 1
  explicit PositionWeight(double correlation_s) : correlation_s_(correlation_s) {}

  double of(Time t) const {
    return has_last_ ? gnss_position_weight(to_seconds(t - last_), correlation_s_) : 1.0;
  }
  void fused(Time t) {
    last_ = t;
    has_last_ = true;
  }

  /// The state that a snapshot keeps.
  template <class Archive>
  void visit(Archive& archive) {
    archive(last_, has_last_);
  }

 private:
  double correlation_s_;
  Time last_{};
  bool has_last_{false};
};

/// Linearizes the fix about the estimate: 3 rows for a position or a velocity, 6 for both, position
/// first. @pre is_usable(fix), fix.time is the estimate's time.
/// Source: Groves (2013) (14.104)-(14.111), ECEF form, signs by error_state.hpp.
Measurement gnss_measurement(const GnssFix& fix, const Estimate& estimate,
                             const Eigen::Vector3d& lever_arm_b_m,
                             const Eigen::Vector3d& omega_ib_b_radps);

}  // namespace leeway
