#include <cmath>

#include "leeway/earth/earth.hpp"
#include "sim/atlas/trials.hpp"

namespace leeway::sim::scenes {
namespace {

constexpr double kSettledAfterS = 100.0;
constexpr std::chrono::seconds kFixEvery{10};  // from then on; each second before
constexpr Time kVibratesFrom{std::chrono::seconds{150}};

/// RMS horizontal error before fixes, over what the filter claims for it.
double horizontal_over_claim(WatchedFilter& filter, const RecordedTrial& trial) {
  double squares = 0.0;
  double epochs = 0.0;
  replay(filter, trial, [&](const Estimate& truth, const WatchedFilter& now) {
    if (to_seconds(truth.nav.time) <= kSettledAfterS || !now.has_estimate()) return;
    const Eigen::Vector3d error_n_m = position_error_n_m(truth, now.estimate());
    squares += error_n_m.head<2>().squaredNorm() / claimed_horizontal_m2(truth, *now.covariance());
    epochs += 1.0;
  });
  return std::sqrt(squares / epochs);
}

/// Between fixes that are far apart the sensors' errors show.
void thin_out_fixes(RecordedTrial& trial) {
  std::erase_if(trial.fixes, [](const RecordedTrial::Fix& fix) {
    return to_seconds(fix.fix.time) > kSettledAfterS &&
           fix.fix.time.time_since_epoch() % kFixEvery != Duration{};
  });
}

/// Rectification: what shakes a MEMS sensor shifts its mean, from the moment it shakes.
void rectify(ImuIncrement& inc) {
  if (inc.time <= kVibratesFrom) return;
  inc.dv_b_mps += 0.03 * kStandardGravityMps2 * inc.dt_s * Eigen::Vector3d(1.0, 1.0, 1.0);
  inc.dtheta_b_rad += 0.3 * kRadPerDeg * inc.dt_s * Eigen::Vector3d(1.0, 1.0, 1.0);
}

std::vector<SpoiledCondition> sensor_faults() {
  const auto imu = each_increment;
  return {{"as modelled", [](RecordedTrial&) {}},
          {"gyro scale 3 %", imu([](ImuIncrement& inc) { inc.dtheta_b_rad *= 1.03; })},
          {"accelerometer scale 3 %", imu([](ImuIncrement& inc) { inc.dv_b_mps *= 1.03; })},
          {"g-sensitivity 0.1 deg/s/g", imu([](ImuIncrement& inc) {
             inc.dtheta_b_rad += 0.1 * kRadPerDeg / kStandardGravityMps2 * inc.dv_b_mps;
           })},
          {"vibration shifts biases by 30 mg and 0.3 deg/s", imu(rectify)}};
}

/// What a filter without such states can be told: more noise.
EkfConfig told_as_noise(EkfConfig config) {
  config.imu.gyro.noise_density *= 30.0;
  config.imu.accelerometer.noise_density *= 30.0;
  return config;
}

std::vector<AtlasCell> run_under_modelled(const AtlasOptions& options) {
  Scene scene = town_drive(400.0);
  scene.imu_rate_hz = 50.0;
  const auto trials = spoiled(recorded_trials(scene, options.brief ? 1 : 4), thin_out_fixes);
  const auto columns = claiming(few_atlas_columns());
  return cells_over(sensor_faults(), [&](const SpoiledCondition& fault) {
    const auto faulty = spoiled(trials, fault.spoil);
    auto cells = scored(columns, scene.filter, faulty, fault.condition, horizontal_over_claim);
    append(cells, scored(columns, told_as_noise(scene.filter), faulty,
                         fault.condition + "; told as noise", horizontal_over_claim));
    return cells;
  });
}

}  // namespace

AtlasScene under_modelled() {
  return {
      .place = 320,
      .key = "under-modelled",
      .title = "Sensors that err otherwise than the filter believes",
      .figure = "RMS horizontal error before a fix, over the claimed sigma",
      .limits = {1.5, 3.0, "an honest filter has 1; at 3 what it calls one in twenty is the rule"},
      .run = run_under_modelled};
}

}  // namespace leeway::sim::scenes
