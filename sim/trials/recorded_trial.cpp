#include "sim/trials/recorded_trial.hpp"

#include <algorithm>

#include "leeway/sim/scene/receiver.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"
#include "leeway/sim/tools/random.hpp"
#include "sim/trials/player.hpp"

namespace leeway::sim {

std::vector<TrialPlan::Fix> arriving_fixes(const TrialPlan& plan) {
  std::vector<TrialPlan::Fix> fixes = plan.fixes();
  std::erase_if(fixes, [end = plan.increments().size()](const TrialPlan::Fix& fix) {
    return fix.arrives >= end;
  });
  return fixes;
}

RecordedTrial record_trial(const TrialPlan& plan, std::uint64_t seed) {
  const Scene& scene = plan.scene();
  ImuErrorSimulator sensor(scene.imu, Random(seed, 0, kImuStream));
  Receiver receiver(scene.trajectory, scene.gnss, seed);
  RecordedTrial trial;
  trial.start = trial_start(plan, seed);
  trial.imu.reserve(plan.increments().size());
  trial.fixes.reserve(plan.fixes().size());
  const auto now_s = [&trial] { return to_seconds(trial.imu.back().time); };
  play(
      plan.increments().size(), 1, arriving_fixes(plan),
      [&](std::size_t k) { trial.imu.push_back(sensor.measure(plan.increments()[k])); },
      [&](const TrialPlan::Fix& fix) {
        trial.fixes.push_back({fix.at, fix.arrives, receiver.fix_at(now_s()), {}});
      },
      [&](const TrialPlan::Fix& fix) {
        if (!fix.scored) return;
        Estimate& truth = trial.fixes.back().truth.emplace();
        truth.nav = truth_at(scene.trajectory, now_s()).nav;
        truth.bias = {sensor.accelerometer_bias_mps2(), sensor.gyro_bias_radps()};
      });
  return trial;
}

bool fits(const TrialPlan::Fix& fix, int divider) {
  const auto n = static_cast<std::size_t>(divider);
  return (fix.at + 1) % n == 0 && (fix.arrives + 1) % n == 0;
}

bool fits(const TrialPlan& plan, int divider) {
  return std::all_of(plan.fixes().begin(), plan.fixes().end(),
                     [divider](const TrialPlan::Fix& fix) { return fits(fix, divider); });
}

RecordedTrial at_lower_rate(const RecordedTrial& trial, int divider) {
  const auto n = static_cast<std::size_t>(divider);
  RecordedTrial slower{trial.start, {}, trial.fixes};
  slower.imu.reserve(trial.imu.size() / n);
  for (std::size_t first = 0; first + n <= trial.imu.size(); first += n) {
    ImuIncrement sum = trial.imu[first];
    for (std::size_t k = first + 1; k < first + n; ++k) append(sum, trial.imu[k]);
    slower.imu.push_back(sum);
  }
  for (RecordedTrial::Fix& fix : slower.fixes) {
    fix.at = (fix.at + 1) / n - 1;
    fix.arrives = (fix.arrives + 1) / n - 1;
  }
  return slower;
}

RecordedTrial valid_at_arrival(const RecordedTrial& trial) {
  RecordedTrial late = trial;
  for (RecordedTrial::Fix& fix : late.fixes) {
    fix.at = fix.arrives;
    fix.fix.time = trial.imu[fix.arrives].time;
  }
  return late;
}

}  // namespace leeway::sim
