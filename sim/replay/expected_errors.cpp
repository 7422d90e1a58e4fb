#include "sim/replay/expected_errors.hpp"

#include <algorithm>
#include <cmath>

#include "leeway/earth/earth.hpp"
#include "leeway/model/gnss_measurement.hpp"
#include "leeway/model/horizontal.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/analysis/scene_tracks.hpp"
#include "leeway/sim/motion/recorded_trajectory.hpp"

namespace leeway::sim {
namespace {

constexpr double kSameTimeS = 1e-6;
constexpr double kStepS = 1.0;

std::vector<NavStateNed> motion_of(const LogSurvey& survey) {
  std::vector<NavStateNed> rows;
  for (const Solution& s : survey.solution) rows.push_back(ned_from_nav_state(s.nav));
  return rows;
}

InitialSigma initial_of(const Solution& s) {
  return {s.sigma_attitude_rad.head<2>().maxCoeff(), s.sigma_attitude_rad.z(),
          s.sigma_velocity_n_mps.maxCoeff(), s.sigma_position_n_m.head<2>().maxCoeff()};
}

/// The model with its noise as large as the navigator has found it.
ImuErrorModel with_noise(ImuErrorModel imu, double sigma_scale) {
  for (TriadErrorModel* triad : {&imu.accelerometer, &imu.gyro}) {
    triad->noise_density *= sigma_scale;
    triad->in_run.sigma *= sigma_scale;
  }
  return imu;
}

/// A receiver whose position errs as the filter takes it to: white or correlated.
GnssErrorModel receiver_of(const LogReceiver& log, const EkfConfig& filter) {
  const Eigen::Vector3d sigma_n_m(log.sigma_h_m, log.sigma_h_m, log.sigma_v_m);
  const bool is_white =
      filter.gnss_correlation_s == 0.0 || has_white_error(sigma_n_m.squaredNorm());
  GnssErrorModel errors;
  errors.position_sigma_n_m = is_white ? sigma_n_m : Eigen::Vector3d::Zero();
  errors.correlated_sigma_n_m = is_white ? Eigen::Vector3d::Zero() : sigma_n_m;
  if (!is_white) errors.correlation_time_s = filter.gnss_correlation_s;
  if (std::isfinite(log.sigma_h_mps)) {
    errors.velocity_sigma_n_mps = {log.sigma_h_mps, log.sigma_h_mps, log.sigma_v_mps};
  } else {
    errors.velocity_sigma_n_mps.setConstant(1e3);  // none comes
  }
  errors.lever_arm_b_m = filter.lever_arm_b_m;
  return errors;
}

/// The vehicle with the sensors that have a log, as often as they read.
SceneVehicle vehicle_of(const ReplayInput& input, const LogSurvey& survey,
                        const VehicleConfig& config, double span_s) {
  SceneVehicle vehicle{.config = config};
  const auto set = [&](std::string_view name, const VehicleSensor& usual,
                       std::optional<VehicleSensor>& sensor) {
    for (std::size_t a = 0; a < kAidings.size(); ++a) {
      const auto records = static_cast<double>(survey.result.aiding_summaries[a].records);
      if (kAidings[a].name != name || input.aidings[a].empty() || records == 0.0) continue;
      sensor = VehicleSensor{std::max(span_s / records, 1e-3), usual.sigma};
    }
  };
  set(OdometerSpeed::kName, kUsualOdometer, vehicle.odometer);
  set(BarometricHeight::kName, kUsualBarometer, vehicle.barometer);
  set(MeasuredHeading::kName, kUsualHeading, vehicle.heading);
  return vehicle;
}

/// The two variances whose circle, line or sum a metric measures.
Eigen::Vector2d variances_of(ErrorMetric metric, const Eigen::Matrix3d& P_n_m2, double course_rad) {
  const auto alone = [](double variance_m2) { return Eigen::Vector2d(variance_m2, 0.0); };
  const Eigen::Vector2d along(std::cos(course_rad), std::sin(course_rad));
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Matrix2d P_ne_m2 = P_n_m2.topLeftCorner<2, 2>();
  switch (metric) {
    case ErrorMetric::kAlong95:
      return alone(along.dot(P_ne_m2 * along));
    case ErrorMetric::kCross95:
      return alone(across.dot(P_ne_m2 * across));
    case ErrorMetric::kVertical95:
      return alone(P_n_m2(2, 2));
    case ErrorMetric::k3d:
      return alone(P_n_m2.trace());
    case ErrorMetric::kAxis:
      return alone(principal_variances(P_ne_m2).x());
    default:
      return principal_variances(P_ne_m2);
  }
}

}  // namespace

ExpectedErrors::ExpectedErrors(const ReplayInput& input, const LogSurvey& survey,
                               const NavigatorConfig& config, ErrorMetric metric)
    : start_s_(to_seconds(survey.solution.front().nav.time)) {
  RecordedParameters parameters;
  parameters.file = input.imu;
  parameters.max_gap_s = config.max_jump_s;
  scene_.name = input.imu.string();
  scene_.trajectory = recorded_trajectory(motion_of(survey), parameters);
  scene_.duration_s = scene_.trajectory.duration_s;
  scene_.filter = config.filter;
  scene_.imu = with_noise(config.filter.imu, survey.imu_sigma_scale);
  scene_.filter.imu = scene_.imu;
  scene_.estimator = SceneEstimator::kNavigator;
  scene_.gnss.errors = receiver_of(survey.receiver, config.filter);
  scene_.gnss.settle_interval_s = survey.receiver.interval_s;
  scene_.vehicle = vehicle_of(input, survey, config.vehicle, scene_.duration_s);
  scene_.initial = initial_of(survey.solution.front());
  scene_.limit.metric = metric;
  const auto rests_at = [&](double t_s) {
    const auto row = std::lower_bound(survey.solution.begin(), std::prev(survey.solution.end()),
                                      time_from_seconds(start_s_ + t_s),
                                      [](const Solution& s, Time t) { return s.nav.time < t; });
    return static_cast<bool>(
        survey.at_rest[static_cast<std::size_t>(row - survey.solution.begin())]);
  };
  track_.emplace(SceneTracks().of(scene_, kStepS, rests_at));
}

std::vector<Eigen::Vector2d> ExpectedErrors::variances_m2(
    const Thinning& thinning, bool against_fixes, const std::function<bool(double)>& wanted) const {
  Scene scene = scene_;
  scene.gnss.settle_s = thinning.start_s - start_s_;
  scene.gnss.interval_s = thinning.interval_s;
  std::vector<Eigen::Vector2d> variances;
  follow(scene, *track_, [&](const CovariancePoint& point) {
    if (point.moment != CovariancePoint::Moment::kBeforeFix) return;
    if (point.t_s <= scene.gnss.settle_s + kSameTimeS || !wanted(start_s_ + point.t_s)) return;
    const Eigen::Matrix3d P_n_m2 =
        against_fixes ? point.innovation_n_m2
                      : ned_covariance(point.r_e_m, point.truth.block<3, 3>(kDr, kDr));
    const ErrorMetric metric = scene.limit.metric;
    const double course_rad = asks_for_course(metric) ? track_->path().course_rad(point.t_s) : 0.0;
    variances.push_back(variances_of(metric, P_n_m2, course_rad));
  });
  return variances;
}

}  // namespace leeway::sim
