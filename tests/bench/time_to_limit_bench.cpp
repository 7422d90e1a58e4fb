// What time_to_limit costs.
#include <benchmark/benchmark.h>

#include "leeway/ekf/time_to_limit.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/filters/ekf/settled.hpp"

namespace leeway {
namespace {

Ekf filter_on(const sim::Trajectory& trajectory, ImuClass imu) {
  return test::settled(trajectory, imu_class_model(imu, RangeEnd::kMid), 100.0, 0.1).filter;
}

void run(benchmark::State& state, const sim::Trajectory& trajectory, ImuClass imu) {
  const Ekf filter = filter_on(trajectory, imu);
  const double limit_m = static_cast<double>(state.range(0));
  TimeToLimit leeway;
  for (auto _ : state) {
    leeway = time_to_limit(filter, limit_m);
    benchmark::DoNotOptimize(leeway);
  }
  state.counters["leeway_s"] = leeway.time_s;
}

void straight_automotive(benchmark::State& s) { run(s, sim::straight(), ImuClass::kAutomotive); }
void straight_tactical(benchmark::State& s) { run(s, sim::straight(), ImuClass::kTactical); }
void static_marine(benchmark::State& s) { run(s, sim::static_trajectory(), ImuClass::kMarine); }
void circle_automotive(benchmark::State& s) { run(s, sim::circle(), ImuClass::kAutomotive); }
void circle_tactical(benchmark::State& s) { run(s, sim::circle(), ImuClass::kTactical); }
void circle_marine(benchmark::State& s) { run(s, sim::circle(), ImuClass::kMarine); }

BENCHMARK(straight_automotive)->Arg(1)->Arg(5)->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK(straight_tactical)->Arg(1)->Arg(5)->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK(static_marine)->Arg(1)->Arg(5)->Arg(100)->Arg(100'000)->Unit(benchmark::kMicrosecond);
BENCHMARK(circle_automotive)->Arg(1)->Arg(5)->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK(circle_tactical)->Arg(1)->Arg(5)->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK(circle_marine)->Arg(1)->Arg(5)->Arg(100)->Arg(100'000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace leeway
