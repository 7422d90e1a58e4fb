// Runs each hot kernel some times for callgrind to count its instructions (check.sh). With an
// argument it says instead what the counts depend on.
#include <gnu/libc-version.h>
#include <valgrind/callgrind.h>

#include <Eigen/Core>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include "leeway/covariance/symmetric_kernel.hpp"
#include "leeway/logs/imu_log.hpp"
#include "leeway/logs/solution_writer.hpp"
#include "leeway/strapdown/strapdown.hpp"
#include "tests/bench/covariance_case.hpp"
#include "tests/bench/lap.hpp"
#include "tests/bench/motion.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

/// Each dump of callgrind is one line of the table: what it is titled, "calls name".
template <class F>
void count(const std::string& name, int calls, F&& call) {
  const std::string title = std::to_string(calls) + " " + name;
  CALLGRIND_TOGGLE_COLLECT;
  for (int i = 0; i < calls; ++i) call();
  CALLGRIND_TOGGLE_COLLECT;
  CALLGRIND_DUMP_STATS_AT(title.c_str());
}

constexpr int kCalls = 100;
constexpr int kSecond = test::Lap::kRateHz;

void count_strapdown(const char* name, Scheme scheme) {
  const StrapdownFunction strapdown = strapdown_function({.scheme = scheme});
  NavState nav = test::bench_start().nav;
  ImuHistory history;
  ImuIncrement inc = test::bench_increment();
  count(name, kCalls, [&] {
    inc.time = nav.time + duration_from_seconds(inc.dt_s);
    strapdown(nav, inc, history);
  });
}

void count_strapdowns() {
  count_strapdown("strapdown_explicit_euler", Scheme::kExplicitEuler);
  count_strapdown("strapdown_trapezoid", Scheme::kTrapezoid);
  count_strapdown("strapdown_one_sample", Scheme::kOneSample);
  count_strapdown("strapdown_two_sample", Scheme::kTwoSample);
  count_strapdown("strapdown_runge_kutta_4", Scheme::kRungeKutta4);
}

void count_predicts() {
  const ErrorDynamics dynamics = test::bench_dynamics();
  const Transition aggregated = test::bench_transition(20);
  const ErrorMatrix P = test::bench_covariance();
  SymmetricKernel<double> stepped(P);
  count("predict_one_increment", kCalls, [&] { stepped.propagate(dynamics, test::kBenchNoise); });
  SymmetricKernel<double> propagated(P);
  count("predict_aggregated", kCalls, [&] { propagated.propagate(aggregated, test::kBenchNoise); });
  Transition Phi;
  count("advance", kCalls, [&] { advance(Phi, dynamics); });
}

void count_fix(const char* name, UpdateForm form) {
  const MeasurementRows H = test::bench_fix_rows();
  const MeasurementValues z = MeasurementValues::Zero(6);
  ErrorVector x_hat = ErrorVector::Zero();
  SymmetricKernel<double> kernel(test::bench_covariance(), form);
  count(name, kCalls, [&] { kernel.update(x_hat, H, z); });
}

void count_filter() {
  const test::Lap lap;
  Ekf filter = lap.filter();
  std::int64_t k = 0;
  count("ekf_predict", kSecond, [&] { filter.predict(lap.increment(++k)); });
  const GnssFix fix = lap.fix(k);
  count("ekf_update", 1, [&] { filter.update(fix); });
}

void count_navigator() {
  const test::Lap lap;
  Navigator navigator = lap.navigator();
  std::int64_t k = 0;
  count("navigator_push_imu", kSecond, [&] { navigator.push(lap.increment(++k)); });
  const GnssFix fix = lap.fix(k);
  count("navigator_push_fix", 1, [&] { navigator.push(fix); });
  // From the third on it is known when they come.
  for (int second = 0; second < 3; ++second) {
    for (int i = 0; i < kSecond; ++i) navigator.push(lap.increment(++k));
    const GnssFix between = lap.fix(k, 0.5);
    if (second < 2) {
      navigator.push(between);
    } else {
      count("navigator_push_fix_between", 1, [&] { navigator.push(between); });
    }
  }
}

void count_logs() {
  const test::Lap lap;
  const test::TempDir dir;
  ImuLogWriter writer(dir / "imu.csv");
  for (std::int64_t k = 1; k <= 3 * kSecond; ++k) writer.write(lap.increment(k));
  writer.close();
  ImuLogReader reader(dir / "imu.csv");
  count("imu_log_read", 2 * kSecond, [&] { reader.next(); });
  const Solution solution = lap.navigator().solution();
  SolutionWriter solutions(dir / "solution.csv");
  count("solution_write", kCalls, [&] { solutions.write(solution); });
}

void count_all() {
  count_strapdowns();
  count_predicts();
  count_fix("fix_joseph", UpdateForm::kJoseph);
  count_fix("fix_simple", UpdateForm::kSimple);
  count_filter();
  count_navigator();
  count_logs();
}

void print_build() {
#ifdef __clang__
  const char* const compiler = "clang";
#else
  const char* const compiler = "g++";
#endif
  std::printf("%s %s, libstdc++ %d, glibc %s, Eigen %d.%d.%d, %s\n", compiler, __VERSION__,
              __GLIBCXX__, gnu_get_libc_version(), EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION,
              EIGEN_MINOR_VERSION, LEEWAY_BUILD);
}

}  // namespace
}  // namespace leeway

int main(int argc, char**) {
  if (argc > 1) {
    leeway::print_build();
  } else {
    leeway::count_all();
  }
}
