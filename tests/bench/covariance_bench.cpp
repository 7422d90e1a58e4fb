// What the covariance costs: predict and update. Build with the preset bench.
#include "leeway/filters/covariance.hpp"

#include <benchmark/benchmark.h>

#include "bench/motion.hpp"

namespace leeway {
namespace {

ErrorMatrix start_covariance() {
  ErrorVector sigma;
  sigma << Eigen::Vector3d::Constant(0.01), Eigen::Vector3d::Constant(0.1),
      Eigen::Vector3d::Constant(2.0), Eigen::Vector3d::Constant(0.05),
      Eigen::Vector3d::Constant(1e-3);
  return sigma.cwiseAbs2().asDiagonal();
}

constexpr ProcessNoise kNoise{1e-8, 1e-6, 1e-9, 1e-12};

void advance_one(benchmark::State& state) {
  const ErrorDynamics dynamics = test::bench_dynamics();
  Transition Phi;
  int left = 20;
  for (auto _ : state) {
    advance(Phi, dynamics);
    if (--left > 0) continue;
    Phi = Transition{};
    left = 20;
  }
}
BENCHMARK(advance_one);

void propagate_one(benchmark::State& state) {
  Transition Phi;
  advance(Phi, test::bench_dynamics());
  ErrorMatrix P = start_covariance();
  int left = 1000;
  for (auto _ : state) {
    propagate(P, Phi, kNoise);
    if (--left > 0) continue;
    P = start_covariance();
    left = 1000;
  }
}
BENCHMARK(propagate_one);

void dense_product(benchmark::State& state) {
  Transition step;
  advance(step, test::bench_dynamics());
  const ErrorMatrix Phi = dense(step);
  const ErrorMatrix Q = 1e-12 * start_covariance();
  ErrorMatrix P = start_covariance();
  int left = 1000;
  for (auto _ : state) {
    P = Phi * P * Phi.transpose() + Q;
    benchmark::DoNotOptimize(P.data());
    benchmark::ClobberMemory();
    if (--left > 0) continue;
    P = start_covariance();
    left = 1000;
  }
}
BENCHMARK(dense_product);

void six_updates(benchmark::State& state) {
  ErrorMatrix P = start_covariance();
  ErrorVector x = ErrorVector::Zero();
  for (auto _ : state) {
    P.diagonal() += 1e-2 * start_covariance().diagonal();
    for (int i = 0; i < 6; ++i) {
      ErrorVector h = ErrorVector::Zero();
      h(kDv + i) = 1.0;
      h.head<3>().setConstant(0.5);
      scalar_update(P, x, h, 0.1);
    }
  }
}
BENCHMARK(six_updates);

}  // namespace
}  // namespace leeway

BENCHMARK_MAIN();
