/// @file
/// A scene: everything a study needs to know, as plain data. The motion, what the sensors and the
/// receiver really do, what the filter believes, and the error that is allowed.
#pragma once

#include "leeway/ekf/ekf.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/sim/scene/error_limit.hpp"
#include "leeway/sim/scene/outage.hpp"
#include "leeway/sim/scene/scene_vehicle.hpp"
#include "leeway/sim/sensors/gnss_simulator.hpp"

namespace leeway::sim {

/// When fixes come, and what is wrong with them beyond their model.
struct GnssScenario {
  GnssErrorModel errors{};
  double interval_s{1.0};           ///< fixes are valid at interval, 2 interval, ..
  double settle_s{0.0};             ///< .. after this time; until then as below
  double settle_interval_s{1.0};    ///< the receiver's own: at 1, 2, .. of them until settle_s
  double latency_s{0.0};            ///< a fix reaches the filter this long after its time
  std::vector<Outage> outages{};    ///< no fixes within them
  double outlier_probability{0.0};  ///< of a fix
  double outlier_sigma_m{50.0};     ///< 1 sigma per axis that an outlier adds to the position

  static auto visit(auto& c, const auto& visitor) {
    return visitor(Field{"errors", c.errors}, Field{"interval_s", c.interval_s, between(1e-3, 1e6)},
                   Field{"settle_s", c.settle_s, between(0.0, 1e6)},
                   Field{"settle_interval_s", c.settle_interval_s, between(1e-3, 1e6)},
                   Field{"latency_s", c.latency_s, between(0.0, 60.0)}, Field{"outages", c.outages},
                   Field{"outlier_probability", c.outlier_probability, between(0.0, 0.5)},
                   Field{"outlier_sigma_m", c.outlier_sigma_m, between(0.0, 1e6)});
  }
};

/// What estimates in a scene.
enum class SceneEstimator {
  kEkf,        ///< the filter alone, started at the scene's start
  kNavigator,  ///< all that a vehicle runs: alignment, gate recovery, vehicle aiding
};
constexpr auto names(SceneEstimator) { return std::array{"ekf", "navigator"}; }

/// A scene. Times in s from its start.
struct Scene {
  std::string name{};
  Trajectory trajectory{};
  double duration_s{};  ///< results are for the end of it; at most the trajectory's
  double imu_rate_hz{50.0};
  std::string imu_name{};
  ImuErrorModel imu{};  ///< what the sensors are
  GnssScenario gnss{};
  SceneEstimator estimator{SceneEstimator::kEkf};
  EkfConfig filter{};                     ///< what the filter believes
  int imu_divider{1};                     ///< so many increments are added to one for the filter
  std::optional<SceneVehicle> vehicle{};  ///< absent: nothing is known of it
  std::optional<InitialSigma> initial{};  ///< absent: by levelling and gyrocompassing
  ErrorLimit limit{};
  int trials{200};
  std::uint64_t first_seed{1};  ///< trial k has seed first_seed + k

  static auto visit(auto& c, const auto& visitor) {
    return visitor(
        Field{"name", c.name}, NoData{} /* trajectory */,
        Field{"duration_s", c.duration_s, kPositive},
        Field{"imu_rate_hz", c.imu_rate_hz, between(1.0, 1e4)}, Field{"imu_name", c.imu_name},
        Field{"imu", c.imu}, Field{"gnss", c.gnss}, Field{"estimator", c.estimator},
        Field{"filter", c.filter}, Field{"imu_divider", c.imu_divider, between(1.0, 1e3)},
        Field{"vehicle", c.vehicle}, Field{"initial", c.initial}, Field{"limit", c.limit},
        Field{"trials", c.trials, between(1.0, 1e9)}, Field{"first_seed", c.first_seed});
  }
};

/// A check of every number. @throws Error naming the field, its value and the allowed range.
void validate(const Scene& scene);

/// A change of the IMU: the truth, the filter's belief in it, and the name.
void set_imu(Scene& scene, const std::string& name, const ImuErrorModel& model);

/// The start errors that the scene states, or those of a start by levelling (tilt: accelerometer
/// bias over gravity) and gyrocompassing (heading: gyro bias over the horizontal Earth rate, within
/// 1e-5 rad and 10 deg), at the GNSS's own sigmas of velocity and horizontal position.
InitialSigma initial_sigma(const Scene& scene);

/// Length in s of the last part of the scene, whose fixes count by their arrival: all after the
/// time to settle, or, without one, repeating_part_s().
double scored_part_s(const Scene& scene);

/// Length in s of a stretch that is worth comparing with the next one: limit.last_s, two fix
/// intervals or a period of the trajectory, whichever is longest.
double repeating_part_s(const Scene& scene);

/// The longest time between fixes in s that the scene can be asked for: half its duration, so that
/// fixes repeat, and no longer than that one arrives after the time to settle.
double longest_interval_s(const Scene& scene);

/// How the scene's navigator is told to run.
NavigatorConfig navigator_config(const Scene& scene);

/// Times in s of the fixes that are not in an outage, ascending, in (0, duration].
std::vector<double> fix_times_s(const GnssScenario& gnss, double duration_s);

}  // namespace leeway::sim
