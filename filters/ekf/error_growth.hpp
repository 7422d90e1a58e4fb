/// @file
/// How errors grow while a vehicle keeps its motion: the linear map of the error over a time, made
/// longer by composing it with itself.
#pragma once

#include <Eigen/Core>

#include "leeway/covariance/covariance.hpp"
#include "leeway/covariance/transition.hpp"
#include "leeway/ekf/ekf.hpp"
#include "leeway/model/process_noise.hpp"

namespace leeway {

/// The present motion held: speed, rate of climb, rate of turn. Errors are resolved in axes l, the
/// Earth-fixed ones now, which from now on turn with the vehicle and with the local vertical. In
/// them velocity, specific force, body axes, vertical and gravity gradient stand still, and so do
/// the error dynamics, but for the Earth's rotation.
struct SteadyMotion {
  Eigen::Vector3d v_e_mps{Eigen::Vector3d::Zero()};
  Eigen::Vector3d down_e{Eigen::Vector3d::UnitZ()};
  Eigen::Matrix3d C_eb{Eigen::Matrix3d::Identity()};
  Eigen::Matrix3d gravity_gradient_e{Eigen::Matrix3d::Zero()};
  double turn_radps{0.0};                                   ///< relative to the Earth, about down
  Eigen::Vector3d omega_el_radps{Eigen::Vector3d::Zero()};  ///< of the axes l
  Eigen::Vector3d f_mps2{Eigen::Vector3d::Zero()};          ///< that holds the motion
  ProcessNoise noise{};
};

SteadyMotion steady_motion(const Ekf& filter);

/// x(end) = Phi x(start) + w, w ~ N(0, Q), in the axes l of either time.
struct Coasting {
  Transition Phi{};
  ErrorMatrix Q{ErrorMatrix::Zero()};
};

/// From now on, over a step short against every period of the motion. Second order in it.
Coasting first_step(const SteadyMotion& motion, double dt_s);

/// `next` as it is when it starts at start_s instead of now: in the axes l the Earth's rotation has
/// turned meanwhile. The difference acts half at its start and half at its end.
Coasting started_later(const Coasting& next, const SteadyMotion& motion, double start_s);

/// One after the other.
Coasting compose(const Coasting& later, const Coasting& earlier);

/// P <- Phi P Phi^T + Q.
void apply(const Coasting& step, ErrorMatrix& P);

}  // namespace leeway
