// What each vehicle aiding costs when it acts, beside one step of the filter.
#include <benchmark/benchmark.h>

#include "leeway/model/initial_covariance.hpp"
#include "leeway/model/vehicle_measurements.hpp"
#include "leeway/navigator/aidings.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/sensors/imu_simulator.hpp"

namespace leeway {
namespace {

/// On a circle at 20 m/s, the vehicle's parameters estimated.
Ekf car() {
  Estimate start;
  start.nav = sim::truth_at(sim::circle(), 0.0).nav;
  Ekf filter({}, start, initial_covariance(start, {0.01, 0.05, 0.1, 3.0}, automotive_mems_model()));
  edit(filter, [](Belief& belief) { belief.vehicle = vehicle_state(VehicleConfig::car()); });
  return filter;
}

/// @param measure  the measurement for a filter, its linearization included
template <class F>
void run(benchmark::State& state, F&& measure) {
  const Ekf fresh = car();
  Ekf filter = fresh;
  int until_fresh = 1000;  // before the variances shrink to nothing
  for (auto _ : state) {
    benchmark::DoNotOptimize(filter.update(measure(filter)));
    if (--until_fresh > 0) continue;
    until_fresh = 1000;
    filter = fresh;
  }
}

void step(benchmark::State& state) {
  const auto lap = sim::true_increments(sim::circle(), 200.0, 60.0);
  Ekf filter = car();
  ImuBlocks blocks;
  std::size_t k = 0;
  for (auto _ : state) {
    ImuIncrement inc = lap[k++ % lap.size()];
    inc.time = filter.estimate().nav.time + duration_from_seconds(inc.dt_s);
    filter.predict(inc);
  }
}

void block(benchmark::State& state) {
  const auto lap = sim::true_increments(sim::circle(), 200.0, 60.0);
  ImuBlocks blocks;
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(blocks.push(lap[k++ % lap.size()]));
}

BENCHMARK(step)->Name("predict, each sample");
BENCHMARK(block)->Name("standstill statistics, each sample");
BENCHMARK_CAPTURE(run, zero_velocity, [](const Ekf& filter) {
  return zero_velocity(filter.estimate(), 20.0);
})->Name("zero velocity");
BENCHMARK_CAPTURE(run, zero_angular_rate, [](const Ekf& filter) {
  return zero_angular_rate(filter.estimate(), Eigen::Vector3d(0.0, 0.0, 0.2), 1.0);
})->Name("zero angular rate");
BENCHMARK_CAPTURE(run, non_holonomic, [](const Ekf& filter) {
  return non_holonomic(filter.estimate(), filter.vehicle()->value,
                       filter.inertial().omega_ib_b_radps(), 0.1, 0.1);
})->Name("non-holonomic");
BENCHMARK_CAPTURE(run, odometer, [](const Ekf& filter) {
  return measurement(OdometerSpeed{{}, 20.0, 0.1}, filter.estimate(), filter.vehicle()->value,
                     filter.inertial().omega_ib_b_radps());
})->Name("odometer");
BENCHMARK_CAPTURE(run, barometer, [](const Ekf& filter) {
  return measurement(BarometricHeight{{}, 0.0, 1.0}, filter.estimate(), filter.vehicle()->value,
                     filter.inertial().omega_ib_b_radps());
})->Name("barometer");

}  // namespace
}  // namespace leeway
