/// @file
/// A GNSS fix: position and/or velocity with 3x3 covariances. What is absent is absent in the type.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/time.hpp"

namespace leeway {

/// Antenna position in ECEF with its covariance in ECEF axes.
struct GnssPosition {
  Eigen::Vector3d r_e_m{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d R_e_m2{Eigen::Matrix3d::Identity()};

  /// Position from geodetic coordinates and a covariance in north-east-down axes.
  static GnssPosition from_geodetic(const Geodetic& position, const Eigen::Matrix3d& R_n_m2);
};

/// Antenna velocity in ECEF with its covariance in ECEF axes.
struct GnssVelocity {
  Eigen::Vector3d v_e_mps{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d R_e_m2ps2{Eigen::Matrix3d::Identity()};

  /// Velocity from north-east-down components at a place and a covariance in the same axes.
  static GnssVelocity from_ned(const Geodetic& place, const Eigen::Vector3d& v_n_mps,
                               const Eigen::Matrix3d& R_n_m2ps2);
};

/// Heading of the body's x axis, from two antennas: clockwise from true north.
struct GnssHeading {
  double heading_rad{};
  double sigma_rad{0.035};  ///< where a receiver tells none: 2 deg
};

/// One epoch of a receiver. Any part may be missing, not all. The heading is for a Navigator, which
/// takes it as a MeasuredHeading; a filter by itself leaves it alone.
struct GnssFix {
  Time time{};
  std::optional<GnssPosition> position{};
  std::optional<GnssVelocity> velocity{};
  std::optional<GnssHeading> heading{};
};

/// The least standard deviation of a measurement, m or m/s. Below it squares and their inverses run
/// out of range; no sensor claims so little.
inline constexpr double kLeastSigma = 1e-12;

/// Whether a fix can be used: it has a position or a velocity, all numbers are finite and the position is within 100
/// km of the ellipsoid's surface. Every covariance is symmetric and positive definite, with at
/// least kLeastSigma given the other axes. A fix that fails is bad data: count it, use nothing of
/// it.
bool is_usable(const GnssFix& fix);

/// Agreement of two fixes: the way between them is what their velocities say. It is judged by their
/// covariances and an acceleration that changes by 3 m/s^2 in between, at 99.9 %. False unless both
/// fixes are whole and at most 5 s apart. @pre is_usable() of both.
bool agree(const GnssFix& earlier, const GnssFix& later);

}  // namespace leeway
