/// @file
/// All that a filter believes at one time, for those who know better than its measurements do.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/time.hpp"
#include "leeway/model/error_state.hpp"
#include "leeway/model/process_noise.hpp"
#include "leeway/model/vehicle_state.hpp"

namespace leeway {

/// Estimate, the covariance of its error, and the vehicle's parameters where they are estimated.
struct Belief {
  Estimate estimate{};
  ErrorMatrix P{ErrorMatrix::Identity()};
  std::optional<VehicleState> vehicle{};
};

/// Multiplies every covariance: what the filter knows has proved wrong. @pre factor >= 1.
void widen(Belief& belief, double factor);

/// Puts position and velocity anew, independent of everything else; attitude and biases stay.
/// @pre everything finite, covariances symmetric positive definite.
void restart_motion(Belief& belief, const Eigen::Vector3d& r_e_m, const Eigen::Matrix3d& P_rr_m2,
                    const Eigen::Vector3d& v_e_mps, const Eigen::Matrix3d& P_vv_m2ps2);

/// Raises the negative directions of P to a billionth of their scale, in correlations, so that no
/// state is small beside another for its unit alone.
void make_positive_definite(ErrorMatrix& P);

/// 1 sigma of what a vehicle turns over a time in which nobody looks: at 0.5 rad/s, up to 1.8 rad: anywhere.
double unseen_turn_rad(double dt_s);

/// Carries the belief over a time without IMU data: constant velocity relative to the Earth,
/// attitude held in the Earth-fixed frame. Its uncertainty grows as that of a vehicle that may
/// turn, lean at 0.5 rad/s up to 0.1 rad, and accelerate at 3 m/s^2 (1 sigma).
/// @param before_s  how long nobody had looked before: what is unseen goes on
/// @pre to > belief.estimate.nav.time.
void bridge(Belief& belief, Time to, const ProcessNoise& noise, double before_s);

/// Whether estimate and covariance are numbers of a size that arithmetic can bear.
bool is_sane(const Estimate& estimate, const ErrorMatrix& P);

}  // namespace leeway
