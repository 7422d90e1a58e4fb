// What a study costs: covariance analysis, and Monte Carlo on threads. campaign_ranks is for mpirun
// to start, and alone: every rank must run it, and equally often.
#include <benchmark/benchmark.h>

#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/analysis/covariance_analysis.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/trials/campaign.hpp"

namespace leeway::sim {
namespace {

/// As docs/examples/scenes/square-loop.toml, but shorter.
Scene square_loop_scene() {
  constexpr double kDurationS = 1200.0;
  Scene scene;
  scene.trajectory = square_loop({.duration_s = kDurationS});
  scene.duration_s = kDurationS;
  scene.filter.gnss_correlation_s = 0.0;
  scene.filter.gate_probability = 0.0;
  scene.trials = 16;
  set_imu(scene, "tactical", imu_class_model(ImuClass::kTactical, RangeEnd::kMid));
  return scene;
}

/// How much there is of it in a second.
void count(benchmark::State& state, const char* what, double per_iteration) {
  state.counters[what] =
      benchmark::Counter(per_iteration, benchmark::Counter::kIsIterationInvariantRate);
}

void analysis_track(benchmark::State& state) {
  const Scene scene = square_loop_scene();
  for (auto _ : state) benchmark::DoNotOptimize(error_track(scene));
  count(state, "scene_s/s", scene.duration_s);
}

void analysis(benchmark::State& state, bool by_source) {
  const Scene scene = square_loop_scene();
  const ErrorTrack track = error_track(scene);
  for (auto _ : state) {
    benchmark::DoNotOptimize(analyze(scene, track, {.by_source = by_source}).true_m);
  }
  count(state, "scene_s/s", scene.duration_s);
}

void campaign_threads(benchmark::State& state) {
  const Scene scene = square_loop_scene();
  CampaignOptions options;
  options.threads = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(campaign(scene, options).mean_nees);
  count(state, "trials/s", scene.trials);
}

void campaign_ranks(benchmark::State& state) {
  static const Ranks ranks;
  const Scene scene = square_loop_scene();
  for (auto _ : state) benchmark::DoNotOptimize(campaign(scene, {}, ranks).mean_nees);
  count(state, "trials/s", scene.trials);
  state.counters["ranks"] = ranks.count();
}

BENCHMARK(analysis_track)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(analysis, whole, false)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(analysis, by_source, true)->Unit(benchmark::kMillisecond);
BENCHMARK(campaign_threads)
    ->Arg(1)
    ->Arg(2)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(campaign_ranks)
    ->Iterations(1)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace leeway::sim
