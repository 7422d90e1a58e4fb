#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <limits>

#include "leeway/earth/earth.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "sim/atlas/free_run.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kLoopRadiusM = 250.0;
constexpr double kLoopMps = 60.0;
constexpr double kLoopS = 2.0 * 180.0 * kRadPerDeg * kLoopRadiusM / kLoopMps;
constexpr double kLoopRateHz = 50.0;

/// Inside loops towards north in a plane that leans from the vertical: the largest pitch is 90 deg
/// less that angle.
Trajectory aerobatic_loops(double lean_rad, double duration_s) {
  Trajectory trajectory;
  trajectory.name = "aerobatic loops";
  trajectory.plane = TangentPlane(kDefaultOrigin);
  trajectory.duration_s = duration_s;
  trajectory.motion = [c = std::cos(lean_rad), s = std::sin(lean_rad)](double t_s) {
    const Jet turned = kLoopMps / kLoopRadiusM * time_jet(t_s);
    const Jet ahead = cos(turned);
    const Jet up = sin(turned);
    LocalMotion m;
    m.north_m = kLoopRadiusM * up;
    m.east_m = kLoopRadiusM * s * (1.0 - ahead);
    m.down_m = -kLoopRadiusM * c * (1.0 - ahead);
    // Forward is (ahead, s up, -c up), right (0, c, s), down their cross product.
    m.yaw_rad = atan2(s * up, ahead);
    m.pitch_rad = atan2(c * up, sqrt(ahead * ahead + s * s * (up * up)));
    m.roll_rad = atan2(Jet(s), c * ahead);
    return m;
  };
  return trajectory;
}

/// The attitude as Euler angles in the tangent plane of the start, by the midpoint rule: their
/// rates have the pitch's cosine below.
class EulerAngleAttitude {
 public:
  EulerAngleAttitude(const TangentPlane& plane, const NavState& start)
      : C_el_(plane.C_el),
        rpy_(euler_from_rotation(C_el_.transpose() * start.q_eb.toRotationMatrix())) {}

  void push(const ImuIncrement& inc) {
    const EulerAngles half = moved(rpy_, rates(rpy_, inc), 0.5 * inc.dt_s);
    rpy_ = moved(rpy_, rates(half, inc), inc.dt_s);
  }

  Eigen::Quaterniond q_eb() const {
    return Eigen::Quaterniond(C_el_ * rotation_from_euler(rpy_)).normalized();
  }

 private:
  Eigen::Vector3d rates(const EulerAngles& rpy, const ImuIncrement& inc) const {
    const Eigen::Matrix3d C_lb = rotation_from_euler(rpy);
    const Eigen::Vector3d omega_lb_b =
        inc.dtheta_b_rad / inc.dt_s - (C_el_ * C_lb).transpose() * earth_rotation_e_radps();
    const double across =
        std::sin(rpy.roll_rad) * omega_lb_b.y() + std::cos(rpy.roll_rad) * omega_lb_b.z();
    const double pitch_rate =
        std::cos(rpy.roll_rad) * omega_lb_b.y() - std::sin(rpy.roll_rad) * omega_lb_b.z();
    return {omega_lb_b.x() + across * std::tan(rpy.pitch_rad), pitch_rate,
            across / std::cos(rpy.pitch_rad)};
  }

  static EulerAngles moved(const EulerAngles& rpy, const Eigen::Vector3d& rates, double dt_s) {
    return {rpy.roll_rad + dt_s * rates.x(), rpy.pitch_rad + dt_s * rates.y(),
            rpy.yaw_rad + dt_s * rates.z()};
  }

  Eigen::Matrix3d C_el_;
  EulerAngles rpy_;
};

double attitude_error_deg(const NavState& truth, const Eigen::Quaterniond& q_eb) {
  NavState nav;
  nav.q_eb = q_eb;
  return attitude_error_e_rad(truth, nav).norm() / kRadPerDeg;
}

std::vector<AtlasCell> free_loops(double lean_deg, double duration_s) {
  const Trajectory loops = aerobatic_loops(lean_deg * kRadPerDeg, duration_s);
  const auto increments = true_increments(loops, kLoopRateHz, duration_s);
  const NavState start = truth_at(loops, 0.0).nav;
  const std::string condition = fmt::format("up to {:g} deg", 90.0 - lean_deg);
  std::vector<NavState> truth;
  for (const ImuIncrement& inc : increments) {
    truth.push_back(truth_at(loops, to_seconds(inc.time)).nav);
  }
  auto cells = free_runs(
      {Scheme::kExplicitEuler, Scheme::kOneSample, Scheme::kTwoSample}, condition, start,
      increments, [largest_deg = 0.0, now = truth.begin()](const NavState& nav) mutable {
        return largest_deg = std::max(largest_deg, attitude_error_deg(*now++, nav.q_eb));
      });
  EulerAngleAttitude angles(loops.plane, start);
  double largest_deg = 0.0;
  for (std::size_t k = 0; k < increments.size(); ++k) {
    angles.push(increments[k]);
    largest_deg = std::max(largest_deg, attitude_error_deg(truth[k], angles.q_eb()));
  }
  cells.push_back({AtlasGroup::kNotOffered, "Euler angles", condition, largest_deg});
  return cells;
}

/// From the second loop on.
double attitude_rms_deg(WatchedFilter& filter, const RecordedTrial& trial) {
  double squares_deg2 = 0.0;
  double epochs = 0.0;
  replay(filter, trial, [&](const Estimate& truth, const WatchedFilter& now) {
    if (to_seconds(truth.nav.time) < kLoopS) return;
    const double error_deg = now.has_estimate()
                                 ? attitude_error_deg(truth.nav, now.estimate().nav.q_eb)
                                 : std::numeric_limits<double>::infinity();
    squares_deg2 += error_deg * error_deg;
    epochs += 1.0;
  });
  return std::sqrt(squares_deg2 / epochs);
}

std::vector<AtlasCell> run_pitch_90(const AtlasOptions& options) {
  const double duration_s = (options.brief ? 2.0 : 4.0) * kLoopS;
  auto cells = cells_over(std::vector{0.0, 0.1, 1.0, 10.0},
                          [&](double lean_deg) { return free_loops(lean_deg, duration_s); });
  const Scene scene =
      drive_scene(aerobatic_loops(0.0, duration_s), kLoopRateHz,
                  {.tilt_rad = 3e-3, .heading_rad = 0.01, .velocity_mps = 0.1, .position_m = 3.0},
                  imu_class_model(ImuClass::kTactical, RangeEnd::kMid));
  append(cells, scored(few_atlas_columns(), scene.filter,
                       recorded_trials(scene, options.brief ? 1 : 4), "with fixes; up to 90 deg",
                       attitude_rms_deg));
  return cells;
}

}  // namespace

AtlasScene pitch_90() {
  return {.place = 210,
          .key = "pitch-90",
          .title = "Loops through a pitch of 90 deg",
          .figure = "largest error of the attitude",
          .unit = "deg",
          .limits = {0.1, 1.0,
                     "a filter on a tactical IMU knows its attitude to a tenth of a degree, one on "
                     "a car-grade IMU to a degree"},
          .run = run_pitch_90};
}

}  // namespace leeway::sim::scenes
