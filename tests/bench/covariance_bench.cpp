// What the covariance costs: a predict and a fix, by kernel and precision. Build with the preset
// bench. Every kernel is restarted now and then, before its variances shrink or grow to nothing.
#include <benchmark/benchmark.h>

#include "bench/motion.hpp"
#include "leeway/filters/covariance.hpp"
#include "leeway/filters/covariance_kernel.hpp"
#include "leeway/filters/dense_kernel.hpp"
#include "leeway/filters/square_root_kernel.hpp"
#include "leeway/filters/symmetric_kernel.hpp"
#include "leeway/filters/ud_kernel.hpp"

namespace leeway {
namespace {

constexpr ProcessNoise kNoise{1e-8, 1e-6, 1e-9, 1e-12};

ErrorMatrix start_covariance() {
  ErrorVector sigma;
  sigma << Eigen::Vector3d::Constant(0.01), Eigen::Vector3d::Constant(0.1),
      Eigen::Vector3d::Constant(2.0), Eigen::Vector3d::Constant(0.05),
      Eigen::Vector3d::Constant(1e-3);
  ErrorMatrix P = sigma.cwiseAbs2().asDiagonal();
  Transition Phi;
  for (int k = 0; k < 200; ++k) advance(Phi, test::bench_dynamics());
  propagate(P, Phi, kNoise);  // so that no correlation is zero
  return P;
}

/// Position and velocity of an antenna beside the IMU, whitened.
MeasurementRows fix_rows() {
  const Eigen::Matrix3d C_eb = test::bench_start().nav.q_eb.toRotationMatrix();
  const Eigen::Vector3d lever_b_m(0.5, 0.3, -1.2);
  const ImuIncrement inc = test::bench_increment();
  const Eigen::Vector3d omega_b_radps = inc.dtheta_b_rad / inc.dt_s;
  MeasurementRows H = MeasurementRows::Zero(6, kErrorStates);
  H.block<3, 3>(0, kPsi) = -skew(C_eb * lever_b_m);
  H.block<3, 3>(0, kDr).setIdentity();
  H.block<3, 3>(3, kPsi) = -skew(C_eb * omega_b_radps.cross(lever_b_m));
  H.block<3, 3>(3, kDv).setIdentity();
  H.block<3, 3>(3, kBg) = C_eb * skew(lever_b_m);
  H.topRows<3>() /= 2.0;
  H.bottomRows<3>() /= 0.05;
  return H;
}

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
  repeat(state, Kernel(start_covariance()),
         [&](Kernel& kernel) { kernel.propagate(dynamics, kNoise); });
}

template <class Kernel>
void predict_advance(benchmark::State& state) {
  const ErrorDynamics dynamics = test::bench_dynamics();
  repeat(state, Kernel(start_covariance()), [&](Kernel& kernel) {
    Transition Phi;
    advance(Phi, dynamics);
    kernel.propagate(Phi, kNoise);
  });
}

template <class Kernel>
void predict_aggregated(benchmark::State& state) {
  Transition Phi;
  for (int k = 0; k < 20; ++k) advance(Phi, test::bench_dynamics());
  repeat(state, Kernel(start_covariance()), [&](Kernel& kernel) { kernel.propagate(Phi, kNoise); });
}

template <class Kernel, auto... form>
void fix(benchmark::State& state) {
  const MeasurementRows H = fix_rows();
  const MeasurementValues z = MeasurementValues::Zero(6);
  ErrorVector x = ErrorVector::Zero();
  repeat(state, Kernel(start_covariance(), form...),
         [&](Kernel& kernel) { kernel.update(x, H, z); });
}

void advance_one(benchmark::State& state) {
  const ErrorDynamics dynamics = test::bench_dynamics();
  repeat(state, Transition{}, [&](Transition& Phi) { advance(Phi, dynamics); });
}

void dense_triple_product(benchmark::State& state) {
  Transition step;
  advance(step, test::bench_dynamics());
  const ErrorMatrix Phi = dense(step);
  const ErrorMatrix Q = 1e-12 * start_covariance();
  repeat(state, start_covariance(), [&](ErrorMatrix& P) { P = Phi * P * Phi.transpose() + Q; });
}

void free_propagate_step(benchmark::State& state) {
  const ErrorDynamics dynamics = test::bench_dynamics();
  repeat(state, start_covariance(), [&](ErrorMatrix& P) { propagate(P, dynamics, kNoise); });
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
BENCHMARK(predict_aggregated<SquareRootKernel<double>>);
BENCHMARK(predict_aggregated<SquareRootKernel<float>>);
BENCHMARK(fix<DenseKernel<double>, UpdateForm::kJoseph>);
BENCHMARK(fix<UdKernel<double>>);
BENCHMARK(fix<UdKernel<float>>);
BENCHMARK(fix<SquareRootKernel<double>>);
BENCHMARK(fix<SquareRootKernel<float>>);
BENCHMARK(fix<SymmetricKernel<double>, UpdateForm::kJoseph>);
BENCHMARK(fix<SymmetricKernel<double>, UpdateForm::kSimple>);
BENCHMARK(fix<SymmetricKernel<double>, UpdateForm::kBatch>);
BENCHMARK(fix<SymmetricKernel<float>, UpdateForm::kJoseph>);

}  // namespace
}  // namespace leeway

BENCHMARK_MAIN();
