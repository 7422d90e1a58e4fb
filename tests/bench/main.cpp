// Runs the benchmarks of a program: for each a line with the median of its repetitions, the least
// and the greatest. Takes the options of Google Benchmark.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "leeway/sim/tools/ranks.hpp"

namespace {

using Run = benchmark::BenchmarkReporter::Run;

/// The time that the benchmark says counts.
double time_of(const Run& run) {
  return run.run_name.time_type.empty() ? run.GetAdjustedCPUTime() : run.GetAdjustedRealTime();
}

class MedianTable : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }

  /// Interleaved benchmarks end in any order.
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      runs_[{run.family_index, run.per_family_instance_index}].push_back(run);
    }
  }

  void Finalize() override {
    std::printf("%-58s %10s %10s %10s\n", "", "median", "least", "greatest");
    for (const auto& [place, repetitions] : runs_) print(repetitions);
  }

 private:
  static std::vector<double> sorted(const std::vector<Run>& runs,
                                    const std::function<double(const Run&)>& value_of) {
    std::vector<double> values;
    for (const Run& run : runs) values.push_back(value_of(run));
    std::sort(values.begin(), values.end());
    return values;
  }

  static double median(const std::vector<Run>& runs,
                       const std::function<double(const Run&)>& value_of) {
    return sorted(runs, value_of)[runs.size() / 2];
  }

  static void print(const std::vector<Run>& runs) {
    const Run& first = runs.front();
    const std::string name = first.run_name.function_name +
                             (first.run_name.args.empty() ? "" : "/" + first.run_name.args);
    if (first.error_occurred) {
      std::printf("%-58s %s\n", name.c_str(), first.error_message.c_str());
      return;
    }
    const std::vector<double> times = sorted(runs, time_of);
    std::printf("%-58s %10.4g %10.4g %10.4g %s", name.c_str(), times[times.size() / 2],
                times.front(), times.back(), benchmark::GetTimeUnitString(first.time_unit));
    if (first.run_name.time_type.starts_with("process_time")) {
      std::printf("  cpu %.4g",
                  median(runs, [](const Run& run) { return run.GetAdjustedCPUTime(); }));
    }
    for (const auto& [counter, ignored] : first.counters) {
      std::printf("  %s %.4g", counter.c_str(),
                  median(runs, [&](const Run& run) { return run.counters.at(counter).value; }));
    }
    std::printf("\n");
  }

  std::map<std::pair<std::int64_t, std::int64_t>, std::vector<Run>> runs_;
};

/// What an MPI rank that is not the first says.
class Silence : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& /*context*/) override { return true; }
  void ReportRuns(const std::vector<Run>& /*runs*/) override {}
};

}  // namespace

int main(int argc, char** argv) {
  const bool first = leeway::sim::Ranks::launched_first();
  const auto is_for_the_first = [](const std::string& option) {
    return option.starts_with("--benchmark_out");
  };
  if (!first) argc = static_cast<int>(std::remove_if(argv, argv + argc, is_for_the_first) - argv);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  if (first) {
    MedianTable table;
    benchmark::RunSpecifiedBenchmarks(&table);
  } else {
    Silence silence;
    benchmark::RunSpecifiedBenchmarks(&silence);
  }
}
