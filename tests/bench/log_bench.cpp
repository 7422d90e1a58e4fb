// A log of 30 minutes, IMU at 200 Hz and fixes at 1 Hz, as `leeway fuse` takes it: read, filter and
// write the solution at 10 Hz, one by one and together. The yardstick is the least that reading can
// cost: std::from_chars over every number of the same file.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "leeway/logs/gnss_log.hpp"
#include "leeway/logs/imu_log.hpp"
#include "leeway/logs/solution_writer.hpp"
#include "leeway/model/initial_covariance.hpp"
#include "leeway/navigator/navigator.hpp"
#include "leeway/sensors/imu_class.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "leeway/sim/replay/replay.hpp"
#include "tests/filters/navigator/recording.hpp"
#include "tests/support/temp_dir.hpp"

namespace leeway {
namespace {

constexpr double kDurationS = 1800.0;
constexpr double kRateHz = 200.0;
constexpr int kStepsPerSolution = 20;

/// The files, and what is in them.
struct Drive {
  test::TempDir dir{};
  std::filesystem::path imu{dir / "imu.csv"};
  std::filesystem::path gnss{dir / "gnss.csv"};
  std::filesystem::path solution{dir / "solution.csv"};
  NavigatorConfig config{};
  Estimate start{};
  test::Recording log{};

  Drive() {
    const sim::Trajectory car = sim::car_drive({.duration_s = kDurationS});
    config.filter.imu = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
    start = test::truth_estimate(car, 0.0);
    log = test::record(car, sim::true_increments(car, kRateHz, kDurationS), config.filter.imu, {},
                       1.0, 1.0, 1);
    ImuLogWriter imu_writer(imu);
    for (const ImuIncrement& inc : log.imu) imu_writer.write(inc);
    imu_writer.close();
    GnssLogWriter gnss_writer(gnss);
    for (const GnssFix& fix : log.fixes) gnss_writer.write(fix);
    gnss_writer.close();
  }
};

const Drive& drive() {
  static const Drive logs;
  return logs;
}

/// For the table to show how much of the IMU log is read in a second.
void count_bytes(benchmark::State& state) {
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(drive().imu));
  state.SetBytesProcessed(state.iterations() * size);
}

/// Of lines with commas between the numbers.
double sum_of_numbers(std::string_view lines) {
  const char* p = lines.data();
  const char* const end = p + lines.size();
  double sum = 0.0;
  while (p < end) {
    double value = 0.0;
    p = std::from_chars(p, end, value).ptr + 1;
    sum += value;
  }
  return sum;
}

/// The same, through a buffer as small as the log reader's.
double sum_of_numbers_in_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string header;
  std::getline(file, header);
  std::string buffer(64 * 1024, '\0');
  std::size_t kept = 0;
  double sum = 0.0;
  while (file.read(buffer.data() + kept, static_cast<std::streamsize>(buffer.size() - kept)),
         file.gcount() > 0) {
    const std::size_t size = kept + static_cast<std::size_t>(file.gcount());
    const std::size_t lines = buffer.rfind('\n', size - 1) + 1;
    sum += sum_of_numbers({buffer.data(), lines});
    kept = size - lines;
    std::copy_n(buffer.data() + lines, kept, buffer.data());
  }
  return sum;
}

void from_chars_in_memory(benchmark::State& state) {
  const std::string text = test::read_file(drive().imu);
  const std::string_view lines = std::string_view(text).substr(text.find('\n') + 1);
  for (auto _ : state) benchmark::DoNotOptimize(sum_of_numbers(lines));
  count_bytes(state);
}

void from_chars_in_file(benchmark::State& state) {
  drive();
  for (auto _ : state) benchmark::DoNotOptimize(sum_of_numbers_in_file(drive().imu));
  count_bytes(state);
}

void read(benchmark::State& state) {
  drive();
  for (auto _ : state) {
    ImuLogReader reader(drive().imu);
    while (const auto inc = reader.next()) benchmark::DoNotOptimize(&*inc);
  }
  count_bytes(state);
}

/// The drive through a filter, each fix before the increment that ends after it.
template <class Fuse, class Step>
void run(Fuse&& fuse, Step&& step) {
  auto fix = drive().log.fixes.begin();
  for (const ImuIncrement& inc : drive().log.imu) {
    for (; fix != drive().log.fixes.end() && fix->time <= inc.time; ++fix) fuse(*fix);
    step(inc);
  }
}

void filter_alone(benchmark::State& state) {
  const EkfConfig& config = drive().config.filter;
  const ErrorMatrix P = initial_covariance(drive().start, {0.01, 0.05, 0.1, 3.0}, config.imu);
  for (auto _ : state) {
    Ekf filter(config, drive().start, P);
    auto fix = drive().log.fixes.begin();
    for (const ImuIncrement& inc : drive().log.imu) {
      filter.predict(inc);
      if (fix != drive().log.fixes.end() && fix->time == inc.time) filter.update(*fix++);
    }
    benchmark::DoNotOptimize(filter.estimate());
  }
}

void filter_in_navigator(benchmark::State& state) {
  drive();
  for (auto _ : state) {
    Navigator navigator(drive().config);
    run([&](const GnssFix& fix) { navigator.push(fix); },
        [&](const ImuIncrement& inc) { navigator.push(inc); });
    benchmark::DoNotOptimize(navigator.aligned());
  }
}

void write(benchmark::State& state) {
  Navigator navigator(drive().config);
  std::vector<Solution> solutions;
  int until_solution = kStepsPerSolution;
  run([&](const GnssFix& fix) { navigator.push(fix); },
      [&](const ImuIncrement& inc) {
        navigator.push(inc);
        if (--until_solution > 0) return;
        until_solution = kStepsPerSolution;
        if (navigator.aligned()) solutions.push_back(navigator.solution());
      });
  for (auto _ : state) {
    SolutionWriter writer(drive().solution);
    for (const Solution& solution : solutions) writer.write(solution);
    writer.close();
  }
}

void whole(benchmark::State& state) {
  sim::ReplayInput input;
  input.imu = drive().imu;
  input.gnss = drive().gnss;
  input.solution = drive().solution;
  for (auto _ : state) benchmark::DoNotOptimize(sim::replay(input, drive().config).fixes);
}

BENCHMARK(from_chars_in_memory)->Unit(benchmark::kMillisecond);
BENCHMARK(from_chars_in_file)->Unit(benchmark::kMillisecond);
BENCHMARK(read)->Unit(benchmark::kMillisecond);
BENCHMARK(filter_alone)->Unit(benchmark::kMillisecond);
BENCHMARK(filter_in_navigator)->Unit(benchmark::kMillisecond);
BENCHMARK(write)->Unit(benchmark::kMillisecond);
BENCHMARK(whole)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace leeway
