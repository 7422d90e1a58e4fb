// What one step of the strapdown costs, scheme by scheme.
#include <benchmark/benchmark.h>

#include "leeway/strapdown/strapdown.hpp"
#include "tests/bench/motion.hpp"

namespace leeway {
namespace {

void step(benchmark::State& state, const StrapdownPolicy& policy) {
  const StrapdownFunction strapdown = strapdown_function(policy);
  NavState nav = test::bench_start().nav;
  ImuHistory history;
  ImuIncrement inc = test::bench_increment();
  const Duration dt = duration_from_seconds(inc.dt_s);
  for (auto _ : state) {
    inc.time = nav.time + dt;
    benchmark::DoNotOptimize(strapdown(nav, inc, history));
  }
}

BENCHMARK_CAPTURE(step, explicit_euler, {.scheme = Scheme::kExplicitEuler});
BENCHMARK_CAPTURE(step, semi_implicit_euler, {.scheme = Scheme::kSemiImplicitEuler});
BENCHMARK_CAPTURE(step, trapezoid, {.scheme = Scheme::kTrapezoid});
BENCHMARK_CAPTURE(step, one_sample, {.scheme = Scheme::kOneSample});
BENCHMARK_CAPTURE(step, one_sample_j2,
                  {.scheme = Scheme::kOneSample, .gravity = GravityModel::kJ2});
BENCHMARK_CAPTURE(step, two_sample, {.scheme = Scheme::kTwoSample});
BENCHMARK_CAPTURE(step, two_sample_j2,
                  {.scheme = Scheme::kTwoSample, .gravity = GravityModel::kJ2});
BENCHMARK_CAPTURE(step, runge_kutta_4, {.scheme = Scheme::kRungeKutta4});

}  // namespace
}  // namespace leeway
