#include "sim/compare/variant_cost.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <utility>

#include "leeway/ekf/ekf_config.hpp"

namespace leeway::sim {

namespace {

constexpr std::uintptr_t kLineBytes = 64;
constexpr std::uintptr_t kPageBytes = 4096;

/// Replays with the stack so far beyond the contender, in their pages.
[[gnu::noinline]] void replay_at(VariantRun& contender, const RecordedTrial& trial,
                                 std::size_t place) {
  const auto frame = reinterpret_cast<std::uintptr_t>(__builtin_frame_address(0));
  const auto filter = reinterpret_cast<std::uintptr_t>(&contender);
  const std::uintptr_t skipped = (frame - filter - kLineBytes * place) % kPageBytes;
  *static_cast<volatile char*>(__builtin_alloca(skipped + 1)) = 0;
  contender.replay(trial, {});
}

}  // namespace

double timed_ns_per_s(const Variant& variant, const EkfConfig& believed, const TrialStart& start,
                      const RecordedTrial& trial, std::size_t place) {
  const auto contender = make_variant_run(variant, believed, start);
  // Time of the processor, not of the clock on the wall: other programs take their turns.
  const std::clock_t begin = std::clock();
  replay_at(*contender, trial, place);
  const auto elapsed = static_cast<double>(std::clock() - begin);
  return elapsed * (1e9 / CLOCKS_PER_SEC) / to_seconds(trial.imu.back().time);
}

Cost cost_of(std::vector<double> ns_per_s) {
  std::sort(ns_per_s.begin(), ns_per_s.end());
  const std::size_t half = ns_per_s.size() / 2;
  const double median =
      ns_per_s.size() % 2 == 1 ? ns_per_s[half] : 0.5 * (ns_per_s[half - 1] + ns_per_s[half]);
  return {median, ns_per_s.front(), ns_per_s.back()};
}

std::vector<Cost> interleaved_costs(const std::vector<TimedRun>& runs, int rounds,
                                    const std::function<void(double)>& progress) {
  std::vector<std::vector<double>> ns_per_s(runs.size());
  for (int round = 0; round < rounds; ++round) {
    // By a stride that visits every place before it comes to one again.
    const std::size_t place = 25 * static_cast<std::size_t>(round);
    for (std::size_t r = 0; r < runs.size(); ++r) ns_per_s[r].push_back(runs[r](place));
    if (progress) progress(static_cast<double>(round + 1) / rounds);
  }
  std::vector<Cost> costs;
  for (std::vector<double>& times : ns_per_s) costs.push_back(cost_of(std::move(times)));
  return costs;
}

}  // namespace leeway::sim
