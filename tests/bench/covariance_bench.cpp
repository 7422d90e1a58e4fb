// What the covariance costs: a predict and a fix, by kernel and precision.
// Every kernel is restarted now and then, before its variances shrink or grow to nothing.
#include <benchmark/benchmark.h>

#include "leeway/alternatives/dense_kernel.hpp"
#include "leeway/alternatives/ud_kernel.hpp"
#include "leeway/covariance/symmetric_kernel.hpp"
#include "tests/bench/covariance_case.hpp"
#include "tests/bench/motion.hpp"

namespace leeway {
namespace {

/// @param act  on a kernel; it is made anew after 200 of them
template <class Kernel, class F>
void repeat(benchmark::State& state, const Kernel& fresh, const F& act) {
  Kernel kernel = fresh;
  int left = 200;
  for (auto _ : state) {
    act(kernel);
    benchmark::DoNotOptimize(&kernel);
    benchmark::ClobberMemory();
    if (--left > 0) continue;
    kernel = fresh;
    left = 200;
  }
}

template <class Kernel>
void predict_step(benchmark::State& state) {
  const ErrorDynamics dynamics = test::bench_dynamics();
  repeat(state, Kernel(test::bench_covariance()),
         [&](Kernel& kernel) { kernel.propagate(dynamics, test::kBenchNoise); });
}

template <class Kernel>
void predict_advance(benchmark::State& state) {
  const ErrorDynamics dynamics = test::bench_dynamics();
  repeat(state, Kernel(test::bench_covariance()), [&](Kernel& kernel) {
    Transition Phi;
    advance(Phi, dynamics);
    kernel.propagate(Phi, test::kBenchNoise);
  });
}

template <class Kernel>
void predict_aggregated(benchmark::State& state) {
  const Transition Phi = test::bench_transition(20);
  repeat(state, Kernel(test::bench_covariance()),
         [&](Kernel& kernel) { kernel.propagate(Phi, test::kBenchNoise); });
}

template <class Kernel, auto... form>
void fix(benchmark::State& state) {
  const MeasurementRows H = test::bench_fix_rows();
  const MeasurementValues z = MeasurementValues::Zero(6);
  ErrorVector x = ErrorVector::Zero();
  repeat(state, Kernel(test::bench_covariance(), form...),
         [&](Kernel& kernel) { kernel.update(x, H, z); });
}

void advance_one(benchmark::State& state) {
  const ErrorDynamics dynamics = test::bench_dynamics();
  repeat(state, Transition{}, [&](Transition& Phi) { advance(Phi, dynamics); });
}

void dense_triple_product(benchmark::State& state) {
  const ErrorMatrix Phi = dense(test::bench_transition(1));
  const ErrorMatrix Q = 1e-12 * test::bench_covariance();
  repeat(state, test::bench_covariance(),
         [&](ErrorMatrix& P) { P = Phi * P * Phi.transpose() + Q; });
}

void free_propagate_step(benchmark::State& state) {
  const ErrorDynamics dynamics = test::bench_dynamics();
  repeat(state, test::bench_covariance(),
         [&](ErrorMatrix& P) { propagate(P, dynamics, test::kBenchNoise); });
}

BENCHMARK(dense_triple_product);
BENCHMARK(advance_one);
BENCHMARK(free_propagate_step);
BENCHMARK(predict_step<SymmetricKernel<double>>);
BENCHMARK(predict_step<SymmetricKernel<float>>);
BENCHMARK(predict_advance<SymmetricKernel<double>>);
BENCHMARK(predict_aggregated<SymmetricKernel<double>>);
BENCHMARK(predict_aggregated<SymmetricKernel<float>>);
BENCHMARK(predict_aggregated<DenseKernel<double>>);
BENCHMARK(predict_aggregated<UdKernel<double>>);
BENCHMARK(predict_aggregated<UdKernel<float>>);
BENCHMARK(fix<DenseKernel<double>, UpdateForm::kSimple>);
BENCHMARK(fix<DenseKernel<double>, UpdateForm::kJoseph>);
BENCHMARK(fix<DenseKernel<double>, UpdateForm::kBatch>);
BENCHMARK(fix<SymmetricKernel<double>, UpdateForm::kSimple>);
BENCHMARK(fix<SymmetricKernel<double>, UpdateForm::kJoseph>);
BENCHMARK(fix<SymmetricKernel<double>, UpdateForm::kBatch>);
BENCHMARK(fix<SymmetricKernel<float>, UpdateForm::kSimple>);
BENCHMARK(fix<SymmetricKernel<float>, UpdateForm::kJoseph>);
BENCHMARK(fix<SymmetricKernel<float>, UpdateForm::kBatch>);
BENCHMARK(fix<UdKernel<double>>);
BENCHMARK(fix<UdKernel<float>>);

}  // namespace
}  // namespace leeway
