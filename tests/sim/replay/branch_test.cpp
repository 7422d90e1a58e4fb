#include "sim/replay/branch.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "leeway/logs/gnss_log.hpp"
#include "leeway/sim/motion/trajectories.hpp"
#include "tests/sim/replay/recorded_logs.hpp"
#include "tests/support/near.hpp"

namespace leeway::sim {
namespace {

std::vector<BranchPlan> plans_of(const std::vector<Outage>& outages) {
  std::vector<BranchPlan> plans;
  for (const Outage& outage : outages) plans.push_back(BranchPlan::of(plans.size(), outage));
  return plans;
}

/// The most that are alive at any start, which is where their number grows.
std::size_t most_alive(const std::vector<BranchPlan>& pass) {
  std::size_t most = 0;
  for (const BranchPlan& at : pass) {
    most = std::max<std::size_t>(most, std::count_if(pass.begin(), pass.end(), [&](const auto& p) {
                                   return p.start <= at.start && p.end >= at.start;
                                 }));
  }
  return most;
}

NavigatorConfig navigator_of(const ImuErrorModel& imu) {
  NavigatorConfig config;
  config.filter.imu = imu;
  config.filter.gnss_correlation_s = 0.0;
  return config;
}

/// The GNSS log with some fixes alone.
std::filesystem::path some_fixes(const test::TempDir& dir, const std::filesystem::path& log,
                                 const std::function<bool(double)>& wanted) {
  GnssLogReader reader(log);
  GnssLogWriter writer(dir / "some.csv");
  while (const auto fix = reader.next()) {
    if (wanted(to_seconds(fix->time))) writer.write(*fix);
  }
  writer.close();
  return dir / "some.csv";
}

}  // namespace

// 1 December 2026: each outage held a copy of the navigator, and 100,000 of them all the memory.
TEST_CASE("of 100,000 outages at once a pass carries no more than asked for") {
  std::vector<Outage> outages;
  for (int k = 0; k < 100'000; ++k) outages.push_back({1e-3 * k, 1000.0});
  const auto passes = passes_of(plans_of(outages), 1000);
  CHECK(passes.size() == 100);
  std::set<std::size_t> seen;
  for (const auto& pass : passes) {
    CHECK(pass.size() == 1000);
    for (const BranchPlan& plan : pass) seen.insert(plan.index);
  }
  CHECK(seen.size() == outages.size());
}

TEST_CASE("outages that follow each other share a pass") {
  std::vector<Outage> outages;
  for (int k = 0; k < 50; ++k) outages.push_back({3.0 * ((7 * k) % 50), 10.0});
  const auto passes = passes_of(plans_of(outages), 2);
  std::size_t all = 0;
  for (const auto& pass : passes) {
    CHECK(most_alive(pass) <= 2);
    all += pass.size();
  }
  CHECK(all == outages.size());
  // Of 10 s each, every 3 s: four are alive at most.
  CHECK(passes.size() == 2);
}

TEST_CASE("more outages than a pass carries cost what they cost in passes of their own") {
  const test::TempDir dir;
  const ImuErrorModel imu = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  ReplayInput input = record_logs(dir, square_loop(), 80.0, imu, {});
  for (std::size_t k = 0; k < kMostBranches + 3; ++k) {
    input.outages.push_back({60.0 + 0.1 * static_cast<double>(k), 10.0});
  }
  const ReplayResult together = replay(input, navigator_of(imu));
  const Outage last = input.outages.back();
  input.outages = {last};
  const ReplayResult alone = replay(input, navigator_of(imu));
  REQUIRE(together.outages.size() == kMostBranches + 3);
  CHECK(together.outages.back().against == Against::kReference);
  CHECK(together.outages.back().outage.start_s == last.start_s);
  CHECK(together.outages.back().end_error_h_m == alone.outages[0].end_error_h_m);
  CHECK(together.rms.horizontal_m == alone.rms.horizontal_m);
}

TEST_CASE("thinned fixes are one each interval, and the others are as if they were not there") {
  const test::TempDir dir;
  const ImuErrorModel imu = imu_class_model(ImuClass::kTactical, RangeEnd::kMid);
  ReplayInput input = record_logs(dir, square_loop(), 120.0, imu, {});
  input.thinnings = {{50.0, 7.0}, {52.0, 30.0}};
  std::vector<ThinnedEpoch> epochs;
  ReplayObserver observer;
  observer.thinned = [&](const ThinnedEpoch& e) { epochs.push_back(e); };
  replay(input, navigator_of(imu), observer);

  std::vector<double> times_s;
  for (const ThinnedEpoch& e : epochs) {
    if (e.thinning == 0) times_s.push_back(e.t_s);
  }
  CHECK(times_s == std::vector<double>{57, 64, 71, 78, 85, 92, 99, 106, 113, 120});
  CHECK(epochs.size() == times_s.size() + 2);  // of the other at 82 and 112

  // On a log without the withheld fixes an outage from one used fix to the next is the same.
  ReplayInput thinned = input;
  thinned.thinnings.clear();
  thinned.gnss = some_fixes(dir, input.gnss, [](double t_s) {
    return t_s < 50.5 || std::fmod(t_s - 50.0 + 1e-6, 7.0) < 1e-3;
  });
  thinned.outages = {{71.0, 7.0}, {106.0, 7.0}};
  const ReplayResult r = replay(thinned, navigator_of(imu));
  for (const OutageResult& outage : r.outages) {
    const double end_s = outage.outage.start_s + outage.outage.duration_s;
    const auto same = std::find_if(epochs.begin(), epochs.end(), [&](const ThinnedEpoch& e) {
      return e.thinning == 0 && test::near(e.t_s, end_s, 1e-6);
    });
    REQUIRE(same != epochs.end());
    // Fixes act at their own time however late they come: what is left is rounding.
    CHECK(test::near(same->error_n_m.head<2>().norm(), outage.end_error_h_m, 1e-6));
  }
}

}  // namespace leeway::sim
