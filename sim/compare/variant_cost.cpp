#include "sim/compare/variant_cost.hpp"

#include <algorithm>
#include <utility>

namespace leeway::sim {

double timed_ns_per_s(const FilterCase& one, GivenTrials& given) {
  const RecordedTrial& trial = given.to(one);
  return 1e9 * run_case(one, trial) / to_seconds(trial.imu.back().time);
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
    for (std::size_t r = 0; r < runs.size(); ++r) ns_per_s[r].push_back(runs[r]());
    if (progress) progress(static_cast<double>(round + 1) / rounds);
  }
  std::vector<Cost> costs;
  for (std::vector<double>& times : ns_per_s) costs.push_back(cost_of(std::move(times)));
  return costs;
}

}  // namespace leeway::sim
