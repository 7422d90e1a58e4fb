// How long one push takes, every one of them timed: a drive at 200 Hz with a fix each second. The
// time in the table is their mean, which counts what else the machine did; the counters tell it
// apart.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#include "leeway/model/claimed_solution.hpp"
#include "leeway/navigator/navigator.hpp"
#include "tests/bench/lap.hpp"

namespace leeway {
namespace {

class Pushes {
 public:
  template <class F>
  void time(benchmark::State& state, F&& push) {
    const auto begin = std::chrono::steady_clock::now();
    push();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    state.SetIterationTime(took.count());
    us_.push_back(static_cast<float>(1e6 * took.count()));
  }

  void report(benchmark::State& state) {
    std::sort(us_.begin(), us_.end());
    const auto at = [this](double share) {
      return us_[static_cast<std::size_t>(share * static_cast<double>(us_.size() - 1))];
    };
    state.counters["p50_us"] = at(0.5);
    state.counters["p99.9_us"] = at(0.999);
    state.counters["max_us"] = at(1.0);
  }

 private:
  std::vector<float> us_{};
};

NavigatorConfig with(const VehicleConfig& vehicle) {
  NavigatorConfig config;
  config.vehicle = vehicle;
  return config;
}

void push_imu(benchmark::State& state, const VehicleConfig& vehicle) {
  const test::Lap lap;
  Navigator navigator = lap.navigator(with(vehicle));
  Pushes pushes;
  std::int64_t k = 0;
  for (auto _ : state) {
    const ImuIncrement inc = lap.increment(++k);
    pushes.time(state, [&] { navigator.push(inc); });
    if (k % test::Lap::kRateHz == 0) navigator.push(lap.fix(k));
  }
  pushes.report(state);
}

/// @param late  samples that have come since the time of the fix, whole ones and parts
void push_fix(benchmark::State& state, const VehicleConfig& vehicle, double late) {
  const test::Lap lap;
  Navigator navigator = lap.navigator(with(vehicle));
  Pushes pushes;
  std::int64_t k = 0;
  for (auto _ : state) {
    for (int i = 0; i < test::Lap::kRateHz; ++i) navigator.push(lap.increment(++k));
    const GnssFix fix = lap.fix(k, late);
    pushes.time(state, [&] { navigator.push(fix); });
  }
  if (navigator.count(Verdict::kFused) == 0) state.SkipWithError("no fix was fused");
  pushes.report(state);
}

void solution(benchmark::State& state) {
  const test::Lap lap;
  Navigator navigator = lap.navigator();
  for (std::int64_t k = 1; k <= 10; ++k) navigator.push(lap.increment(k));
  for (auto _ : state) benchmark::DoNotOptimize(navigator.solution());
}

constexpr double kHalf = 0.5;
constexpr double k500Ms = 0.5 * test::Lap::kRateHz;

BENCHMARK_CAPTURE(push_imu, plain, VehicleConfig{})->UseManualTime();
BENCHMARK_CAPTURE(push_imu, car, VehicleConfig::car())->UseManualTime();
BENCHMARK_CAPTURE(push_fix, plain_on_time, VehicleConfig{}, 0)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(push_fix, car_on_time, VehicleConfig::car(), 0)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(push_fix, plain_between_samples, VehicleConfig{}, kHalf)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(push_fix, plain_500_ms_late, VehicleConfig{}, k500Ms)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(push_fix, car_between_samples, VehicleConfig::car(), kHalf)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(push_fix, car_500_ms_late, VehicleConfig::car(), k500Ms)
    ->UseManualTime()
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(solution);

}  // namespace
}  // namespace leeway
