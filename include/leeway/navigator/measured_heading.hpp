/// @file
/// Measured heading: the reading, the words and columns of its log, what it says of the state, and
/// when refused ones are to be believed.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "leeway/earth/rotation.hpp"
#include "leeway/earth/time.hpp"
#include "leeway/model/heading.hpp"
#include "leeway/model/measurement.hpp"
#include "leeway/navigator/vehicle_aiding.hpp"
#include "leeway/sensors/gnss_fix.hpp"

namespace leeway {

/// Heading by two antennas, a compass, or whoever knows it: of the body's x axis, clockwise from
/// true north.
struct MeasuredHeading {
  Time time{};
  double heading_rad{};
  double sigma_rad{GnssHeading{}.sigma_rad};

  static constexpr const char* kName = "heading";
  static constexpr const char* kLog = "heading log";
  static constexpr const char* kColumns[] = {"heading_deg", "heading_sigma_deg"};
  static constexpr double kUnit = kRadPerDeg;  ///< of the columns, in SI
  static constexpr double kLargest =
      360.0 * kUnit;  ///< of the heading's magnitude and of the sigma
  static constexpr bool VehicleConfig::*kIsOn = &VehicleConfig::heading;
};

/// The body's x axis over ground; with the vehicle's parameters its own forward axis, which is that
/// but for the error of the mount. Nothing in H where it is vertical. 1 row.
inline Measurement measurement(const MeasuredHeading& heading, const Estimate& estimate,
                               const VehicleVector& vehicle,
                               const Eigen::Vector3d& /*omega_ib_b_radps*/) {
  const Eigen::Matrix3d C_eb = estimate.nav.q_eb.toRotationMatrix();
  const Eigen::Vector3d forward_b =
      exp_rotation({0.0, vehicle(kMountPitch), vehicle(kMountYaw)}).col(0);
  const Eigen::Vector3d forward_e = C_eb * forward_b;
  const Azimuth azimuth(forward_e, estimate.nav.r_e_m);
  const Eigen::Vector3d by_mount = forward_b.cross(C_eb.transpose() * azimuth.gradient_e);
  Measurement m(1);
  m.innovation(0) = wrap_pi(heading.heading_rad - azimuth.angle_rad);
  m.H.middleCols<3>(kPsi) = forward_e.cross(azimuth.gradient_e).transpose();
  m.H_vehicle(0, kMountPitch) = by_mount.y();
  m.H_vehicle(0, kMountYaw) = by_mount.z();
  m.R(0, 0) = heading.sigma_rad * heading.sigma_rad;
  return m;
}

/// A compass beside a truck is wrong for a while, a filter that was started by a wrong heading for
/// good: both are refused headings in a row that agree with each other. They are believed when they
/// have done so for longer than headings were fused before, by the clock. No heap, no exceptions.
class RefusedHeadings {
 public:
  /// A heading was fused.
  void fused(Time t);

  /// The gate has refused one.
  /// @param innovation_rad  by which it is off the filter's, -pi to pi
  /// @returns whether the filter's heading is to be doubted; then the row is forgotten
  bool refused(Time t, double innovation_rad, double sigma_rad);

  /// Names every member that changes, for a snapshot.
  template <class Archive>
  void visit(Archive& archive) {
    archive(good_since_, good_until_, refused_since_, innovation_rad_);
  }

 private:
  std::optional<Time> good_since_{};
  std::optional<Time> good_until_{};
  std::optional<Time> refused_since_{};
  double innovation_rad_{0.0};  // of the first in the row
};

}  // namespace leeway
