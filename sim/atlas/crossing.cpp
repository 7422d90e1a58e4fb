#include "sim/atlas/crossing.hpp"

#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/earth/rotation.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/waypoints.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "sim/atlas/free_run.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim {
namespace {

constexpr double kCrossingMps = 250.0;

/// Radii of curvature with the height added, along the meridian and across it.
struct Radii {
  double meridian_m;
  double transverse_m;
};

Radii radii(const Geodetic& position) {
  const double s = std::sin(position.lat_rad);
  const double w_sq = 1.0 - wgs84::kEccentricitySq * s * s;
  const double transverse_m = wgs84::kSemiMajorAxisM / std::sqrt(w_sq);
  return {transverse_m * (1.0 - wgs84::kEccentricitySq) / w_sq + position.height_m,
          transverse_m + position.height_m};
}

/// Rotation of the north-east-down axes over the Earth.
Eigen::Vector3d transport_rate_n(const Geodetic& position, const Eigen::Vector3d& v_n_mps) {
  const Radii r = radii(position);
  return {v_n_mps.y() / r.transverse_m, -v_n_mps.x() / r.meridian_m,
          -v_n_mps.y() * std::tan(position.lat_rad) / r.transverse_m};
}

/// The mechanization of textbooks that the library does not have: latitude, longitude, and north,
/// east and down where the vehicle is. Second order: midpoint of the velocity, attitude and force
/// by increments. Source: Groves (2013), section 5.4.
class NedMechanization {
 public:
  explicit NedMechanization(const NavStateNed& start)
      : position_(start.position),
        v_n_mps_(start.v_n_mps),
        C_nb_(rotation_from_euler(start.attitude)) {}

  void push(const ImuIncrement& inc);

  /// Latitude and longitude move by a share of what is left to a position, as numbers.
  void correct(const Geodetic& position, double share) {
    position_.lat_rad += share * (position.lat_rad - position_.lat_rad);
    position_.lon_rad += share * (position.lon_rad - position_.lon_rad);
  }

  Eigen::Vector3d r_e_m() const { return ecef_from_geodetic(position_); }

 private:
  Geodetic position_;
  Eigen::Vector3d v_n_mps_;
  Eigen::Matrix3d C_nb_;
};

void NedMechanization::push(const ImuIncrement& inc) {
  const double dt_s = inc.dt_s;
  const double lat_rad = position_.lat_rad;
  const Eigen::Vector3d omega_ie_n =
      wgs84::kRotationRateRadps * Eigen::Vector3d(std::cos(lat_rad), 0.0, -std::sin(lat_rad));
  const Eigen::Vector3d omega_en_n = transport_rate_n(position_, v_n_mps_);
  const Eigen::Vector3d g_n =
      ned_to_ecef(position_).transpose() * gravity_e<GravityModel::kNormal>(r_e_m());
  const Eigen::Matrix3d turned = exp_rotation(-dt_s * (omega_ie_n + omega_en_n));
  const Eigen::Vector3d dv_f_n =
      0.5 * (C_nb_ + turned * C_nb_) * left_jacobian_times(inc.dtheta_b_rad, inc.dv_b_mps);
  const auto change = [&](const Eigen::Vector3d& v_n) -> Eigen::Vector3d {
    return dv_f_n + dt_s * (g_n - (2.0 * omega_ie_n + omega_en_n).cross(v_n));
  };
  const Eigen::Vector3d v_mid_n = v_n_mps_ + 0.5 * change(v_n_mps_);
  const Radii r = radii(position_);
  v_n_mps_ += change(v_mid_n);
  C_nb_ = turned * C_nb_ * exp_rotation(inc.dtheta_b_rad);
  position_.lat_rad += dt_s * v_mid_n.x() / r.meridian_m;
  position_.lon_rad += dt_s * v_mid_n.y() / (r.transverse_m * std::cos(lat_rad));
  position_.height_m -= dt_s * v_mid_n.z();
}

std::vector<ImuIncrement> crossing_increments(const Scene& scene) {
  return true_increments(scene.trajectory, scene.imu_rate_hz, scene.duration_s);
}

}  // namespace

Scene crossing(const Geodetic& from, const Geodetic& to) {
  return drive_scene(
      waypoint_trajectory({.waypoints = {{from, kCrossingMps, {}}, {to, kCrossingMps, {}}}}), 50.0,
      {.tilt_rad = 3e-3, .heading_rad = 0.02, .velocity_mps = 0.1, .position_m = 3.0},
      imu_class_model(ImuClass::kTactical, RangeEnd::kMid));
}

std::vector<AtlasCell> crossed_without_fixes(const Scene& scene, const std::string& condition) {
  const auto increments = crossing_increments(scene);
  const NavState start = truth_at(scene.trajectory, 0.0).nav;
  const NavState truth = truth_at(scene.trajectory, to_seconds(increments.back().time)).nav;
  auto cells = free_runs(
      {Scheme::kExplicitEuler, Scheme::kOneSample, Scheme::kTwoSample, Scheme::kRungeKutta4},
      condition, start, increments,
      [&truth](const NavState& nav) { return (truth.r_e_m - nav.r_e_m).norm(); });
  cells.push_back(crossed_in_latitude_and_longitude(scene, condition, 0.0));
  return cells;
}

std::vector<AtlasCell> crossed_with_fixes(const Scene& scene, const std::string& condition,
                                          int trials) {
  return scored(few_atlas_columns(), scene.filter, recorded_trials(scene, trials), condition,
                score_after(0.0, &ErrorSums::position_rms_m));
}

AtlasCell crossed_in_latitude_and_longitude(const Scene& scene, const std::string& condition,
                                            double share) {
  const auto increments = crossing_increments(scene);
  const auto truth = [&](const ImuIncrement& inc) {
    return truth_at(scene.trajectory, to_seconds(inc.time)).nav.r_e_m;
  };
  NedMechanization ned(ned_from_nav_state(truth_at(scene.trajectory, 0.0).nav));
  for (const ImuIncrement& inc : increments) {
    ned.push(inc);
    const bool is_fix = inc.time.time_since_epoch() % std::chrono::seconds{1} == Duration{};
    if (is_fix && share > 0.0) ned.correct(geodetic_from_ecef(truth(inc)), share);
  }
  return {AtlasGroup::kNotOffered,
          share > 0.0 ? "latitude and longitude/blended with fixes" : "latitude and longitude",
          condition, (truth(increments.back()) - ned.r_e_m()).norm()};
}

AtlasLimits crossing_limits() {
  return {10.0, 100.0,
          "fixes of 2.5 m leave some metres; at a hundred an approach to a runway is lost"};
}

}  // namespace leeway::sim
